#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/measure/light_maps/chart.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A triangle or parallelogram in a chart's places (Chart::place), its corners counter-clockwise about +x x +y.
struct TexelOutline {
    TexelOutline(const Chart& chart, const Patch& patch);

    std::array<Vec2, 4> corner;
    std::size_t corners = 0;
    Vec2 lo, hi;
};

/// Points that one texel's light is the mean of.
constexpr std::uint32_t texel_points = 16;

/// How much of a texel lies on its region, and points spread over that with uniform density, of which the first four
/// are well spread by themselves.
struct TexelCover {
    int x = 0, y = 0;       ///< In the chart.
    double share = 0;       ///< In (0, 1].
    std::size_t first = 0;  ///< Of its `texel_points` places.
};

/// The part of a convex polygon in the texel whose corner nearest to (0, 0) is (x, y); `rest` is scratch memory.
void clip_to_texel(std::vector<Vec2>& polygon, int x, int y, std::vector<Vec2>& rest);

/// Cuts the texels of a chart along its region's border. One a thread; keeps its memory.
class TexelCutter {
  public:
    /// The texels of a rectangle of the chart that the region covers, row by row; what the outlines leave uncovered by
    /// rounding counts as covered. `places` of all of them, in the chart's places. O(outlines + texels).
    void cut(std::span<const TexelOutline> outlines, Chart::Rectangle rectangle, std::vector<TexelCover>& covers,
             std::vector<Vec2>& places);

  private:
    struct Triangle {
        std::size_t texel;
        Vec2 a, b, c;
        double area;
    };
    void add(const TexelOutline& outline, const Chart::Rectangle& rectangle);
    void add_part(const TexelOutline& outline, int x, int y, std::size_t texel);
    void add_places(std::span<const Triangle> parts, double area, std::vector<Vec2>& places) const;

    std::vector<double> area_;  ///< Of every texel.
    std::vector<Triangle> parts_;
    std::vector<Vec2> polygon_, rest_;
};

}  // namespace exitance

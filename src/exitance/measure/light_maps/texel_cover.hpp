#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/measure/light_maps/chart.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// A triangle or parallelogram in texel positions of a chart (Chart::place), with corners counter-clockwise in (x, y).
struct TexelOutline {
    TexelOutline(const Chart& chart, const Patch& patch);
    explicit TexelOutline(const std::array<Vec2, 3>& triangle);

    std::array<Vec2, 4> corner;
    std::size_t corners = 0;
    Vec2 lo, hi;

  private:
    void finish();  ///< Orders the corners and sets the bounding box.
};

/// Number of points whose mean is a texel's light.
constexpr std::uint32_t texel_points = 16;

/// Part of a texel that is on its region, with points of uniform density on that part. The first four points alone are
/// well distributed, too.
struct TexelCover {
    int x = 0, y = 0;       ///< Column and row of the texel in the chart.
    double share = 0;       ///< Covered share, in (0, 1].
    std::size_t first = 0;  ///< Index of the first of its `texel_points` positions.
};

/// Clips a convex polygon to the texel whose corner nearest to (0, 0) is (x, y); `rest` is scratch memory.
void clip_to_texel(std::vector<Vec2>& polygon, int x, int y, std::vector<Vec2>& rest);

/// Clips the texels of a chart to its region. One per thread; keeps its memory.
class TexelCutter {
  public:
    /// Computes the texels of a rectangle of the chart that the region covers, row by row. Parts that the outlines
    /// leave uncovered due to rounding count as covered. `places`: the points of all texels, in texel positions of the
    /// chart. O(outlines + texels).
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

    std::vector<double> area_;  ///< Covered area of every texel.
    std::vector<Triangle> parts_;
    std::vector<Vec2> polygon_, rest_;
};

}  // namespace exitance

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/emission_profile.hpp"

namespace exitance {

/// Axis-aligned bounds in a plane.
struct Rectangle {
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;

    void add(Vec2 p) {
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    bool meets(const Rectangle& o) const { return x0 <= o.x1 && o.x0 <= x1 && y0 <= o.y1 && o.y0 <= y1; }
};

/// The visible part of a convex source while occluders are subtracted from it, as convex fragments in coordinates of
/// the source's plane. All 3D points are relative to the receiver x. Can be reused without new allocations.
class LitPart {
  public:
    /// Starts with the whole source: at least three corners, all above the horizon, with x in front of the source.
    void begin(std::span<const Vec3> source);

    /// Bounds of a shape projected from x onto the source's plane; unbounded if a corner has no projection.
    Rectangle bounds(std::span<const Vec3> corners) const;

    /// Subtracts a pyramid with apex x.
    /// pyramid  unit normals of its sides, pointing inwards
    /// bounds  of the pyramid's outline, from bounds()
    /// Returns whether anything is left. O(fragments).
    bool cut(std::span<const Vec3> pyramid, const Rectangle& bounds);

    /// Form factor from x (normal n) to the fragments.
    double form_factor(const Normal& n) const;

    /// Like the above, for a source that is not diffuse (directed_form_factor). `corners`: scratch memory.
    double form_factor(const Normal& n, const RelativeRadiance& p, std::vector<Vec3>& corners) const;

    std::size_t size() const { return fragments_.size(); }
    /// Corners of a fragment, relative to x.
    void corners(std::size_t fragment, std::vector<Vec3>& out) const {
        const Fragment& f = fragments_[fragment];
        out.clear();
        for (std::uint32_t i = 0; i < f.count; ++i) out.push_back(to_space(corners_[f.first + i]));
    }

  private:
    struct Fragment {
        std::uint32_t first, count;  ///< Range in `corners_`.
        Rectangle box;
    };
    struct Line {
        double a, b, c;  ///< Inner side: a x + b y + c >= 0.
        double at(Vec2 p) const { return a * p.x + b * p.y + c; }
    };
    double height(const Line& line, Vec2 p) const {
        const double h = line.at(p);
        return std::abs(h) <= noise_ ? 0 : h;
    }
    Vec3 to_space(Vec2 p) const { return origin_ + p.x * u_ + p.y * v_; }
    bool cut_fragment(const Fragment& fragment);
    void add_fresh(std::uint32_t first);

    std::vector<Vec3> source_;
    Vec3 origin_, u_, v_, normal_;
    double depth_ = 0;  ///< Distance of the source's plane along its normal: normal . r.
    double noise_ = 0;  ///< Distances to a line below this may be due to rounding alone.
    std::vector<Vec2> corners_, rest_, inner_;
    std::vector<double> heights_;
    std::vector<Fragment> fragments_, fresh_;
    std::vector<Line> lines_, crossing_;
};

}  // namespace exitance

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/scene/emission_profile.hpp"

namespace exitance {

/// Bounds in a plane.
struct Rectangle {
    double x0 = HUGE_VAL, y0 = HUGE_VAL, x1 = -HUGE_VAL, y1 = -HUGE_VAL;

    void add(Vec2 p) {
        x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
        y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
    bool meets(const Rectangle& o) const { return x0 <= o.x1 && o.x0 <= x1 && y0 <= o.y1 && o.y0 <= y1; }
};

/// What is left of a convex source as occluders are taken from it: convex fragments in coordinates of the source's
/// plane. All places are relative to the receiver x. Reusable, keeps its memory.
class LitPart {
  public:
    /// The whole source: at least three corners, above the horizon, x in front of it.
    void begin(std::span<const Vec3> source);

    /// Bounds of a shape as thrown from x onto the source's plane; the whole plane where a corner is not thrown there.
    Rectangle bounds(std::span<const Vec3> corners) const;

    /// Takes away the pyramid given by unit normals of its sides (inwards); `bounds` are those of its shape. Returns
    /// whether anything is left. O(fragments).
    bool cut(std::span<const Vec3> pyramid, const Rectangle& bounds);

    /// Form factor from x with normal n to the fragments.
    double form_factor(const Normal& n) const;

    /// The same of a source that does not shine diffusely (directed_form_factor). `corners`: room to work in.
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
        std::uint32_t first, count;  ///< Of the corners.
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
    double depth_ = 0;  ///< normal . r of the plane.
    double noise_ = 0;  ///< Heights that rounding alone may make.
    std::vector<Vec2> corners_, rest_, inner_;
    std::vector<double> heights_;
    std::vector<Fragment> fragments_, fresh_;
    std::vector<Line> lines_, crossing_;
};

}  // namespace exitance

#include "exitance/visibility/lit_part.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/form_factors/directed_form_factor.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// Largest distance of a corner in the source's plane, relative to its own; and margin of bounds, as a share of the
/// largest distance. Both are derived from double precision: the margin covers the rounding of such distances.
constexpr double max_stretch = 1e9, bounds_margin = 1e-9;

/// Adds the part of a convex polygon with sign * heights[i] >= 0. For either sign the cut points are identical.
void add_part(std::span<const Vec2> polygon, std::span<const double> heights, double sign, std::vector<Vec2>& out) {
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const std::size_t j = i + 1 == m ? 0 : i + 1;
        const double a = heights[i], b = heights[j];
        if (sign * a >= 0) out.push_back(polygon[i]);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const bool forward = a < b;
            const Vec2 p = forward ? polygon[i] : polygon[j], q = forward ? polygon[j] : polygon[i];
            const double hp = forward ? a : b, hq = forward ? b : a;
            out.push_back(p + (hp / (hp - hq)) * (q - p));
        }
    }
}

}  // namespace

void LitPart::begin(std::span<const Vec3> source) {
    source_.assign(source.begin(), source.end());
    origin_ = source[0];
    normal_ = {};
    for (std::size_t i = 2; i < source.size(); ++i) normal_ += cross(source[i - 1] - origin_, source[i] - origin_);
    normal_ = normalized(normal_);
    const Frame frame(normal_);
    u_ = frame.u, v_ = frame.v;
    depth_ = dot(normal_, origin_);
    corners_.clear();
    fragments_.clear();
    double reach = 0;
    for (const Vec3& r : source) {
        corners_.push_back({dot(u_, r - origin_), dot(v_, r - origin_)});
        reach = std::max(reach, std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
    }
    noise_ = rounded_sine * reach;
    Fragment whole{0, static_cast<std::uint32_t>(source.size()), {}};
    for (const Vec2& p : corners_) whole.box.add(p);
    fragments_.push_back(whole);
}

Rectangle LitPart::bounds(std::span<const Vec3> corners) const {
    Rectangle box;
    double reach = 0;
    for (const Vec3& r : corners) {
        const double stretch = depth_ / dot(normal_, r);
        if (!(stretch > 0 && stretch < max_stretch)) return {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL};
        const Vec3 on_plane = stretch * r - origin_;
        box.add({dot(u_, on_plane), dot(v_, on_plane)});
        reach = std::max(reach, stretch * (std::abs(r.x) + std::abs(r.y) + std::abs(r.z)));
    }
    const double margin = bounds_margin * reach;
    return {box.x0 - margin, box.y0 - margin, box.x1 + margin, box.y1 + margin};
}

bool LitPart::cut(std::span<const Vec3> pyramid, const Rectangle& bounds) {
    lines_.clear();
    for (const Vec3& side : pyramid) lines_.push_back({dot(side, u_), dot(side, v_), dot(side, origin_)});
    fresh_.clear();
    std::size_t kept = 0;
    for (const Fragment& fragment : fragments_)
        if (!bounds.meets(fragment.box) || !cut_fragment(fragment)) fragments_[kept++] = fragment;
    fragments_.resize(kept);
    fragments_.insert(fragments_.end(), fresh_.begin(), fresh_.end());
    return !fragments_.empty();
}

/// Appends to `fresh_` the parts of a fragment outside the pyramid that `lines_` bound. Returns false, and appends
/// nothing, if that is the whole fragment.
bool LitPart::cut_fragment(const Fragment& fragment) {
    const std::span<const Vec2> whole = std::span(corners_).subspan(fragment.first, fragment.count);
    crossing_.clear();
    for (const Line& line : lines_) {
        bool any_in = false, any_out = false;
        for (const Vec2& p : whole) {
            const double h = line.at(p);
            any_in |= h > noise_, any_out |= h < -noise_;
        }
        if (!any_in) return false;
        if (any_out) crossing_.push_back(line);
    }
    const std::size_t fresh = fresh_.size(), corners = corners_.size();
    rest_.assign(whole.begin(), whole.end());
    for (const Line& line : crossing_) {
        heights_.clear();
        bool any_in = false, any_out = false;
        for (const Vec2& p : rest_) {
            heights_.push_back(height(line, p));
            any_in |= heights_.back() > 0, any_out |= heights_.back() < 0;
        }
        if (!any_in) {  // the fragment is outside the pyramid
            fresh_.resize(fresh);
            corners_.resize(corners);
            return false;
        }
        if (!any_out) continue;
        const auto first = static_cast<std::uint32_t>(corners_.size());
        add_part(rest_, heights_, -1, corners_);
        add_fresh(first);
        inner_.clear();
        add_part(rest_, heights_, 1, inner_);
        std::swap(rest_, inner_);
    }
    return true;
}

void LitPart::add_fresh(std::uint32_t first) {
    Fragment fragment{first, static_cast<std::uint32_t>(corners_.size()) - first, {}};
    if (fragment.count < 3) return corners_.resize(first);
    for (const Vec2& p : std::span(corners_).subspan(first)) fragment.box.add(p);
    fresh_.push_back(fragment);
}

double LitPart::form_factor(const Normal& n) const {
    EdgeSum sum(n, source_);
    for (const Fragment& fragment : fragments_) {
        const std::span<const Vec2> corners = std::span(corners_).subspan(fragment.first, fragment.count);
        Vec3 a = to_space(corners.back());
        for (const Vec2& p : corners) {
            const Vec3 b = to_space(p);
            sum.add(a, b);
            a = b;
        }
    }
    return std::clamp(sum.total(), 0.0, 1.0);
}

double LitPart::form_factor(const Normal& n, const RelativeRadiance& p, std::vector<Vec3>& corners) const {
    double sum = 0;
    for (const Fragment& fragment : fragments_) {
        corners.clear();
        for (const Vec2& c : std::span(corners_).subspan(fragment.first, fragment.count))
            corners.push_back(to_space(c));
        sum += directed_form_factor(n, corners, p);
    }
    return sum;
}

}  // namespace exitance

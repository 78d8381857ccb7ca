#include "exitance/visibility/glazed_part.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/clip_convex.hpp"
#include "exitance/base/limits.hpp"
#include "exitance/form_factors/directed_form_factor.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"

namespace exitance {
namespace {

/// A part of the source, with the panes in front of it.
struct Part {
    std::vector<Vec3> corners;
    std::vector<const Pane*> panes;
};

/// The part of a convex polygon with n . r >= offset.
std::vector<Vec3> cut_above(std::span<const Vec3> polygon, const Vec3& n, double offset = 0) {
    std::vector<Vec3> out;
    clip_convex(
        polygon, [&](const Vec3& r) { return dot(n, r) - offset; }, out);
    if (out.size() < 3) out.clear();
    return out;
}

/// Planes (pointing inwards) through the receiver and the edges of the part of a pane between the receiver and the
/// source, or of all of the pane if `source_plane` is null; empty if no line of sight crosses the pane.
/// source_plane  plane of the source, relative to the receiver
std::vector<Vec3> pyramid_over(const Pane& pane, const SurfacePoint& at, const Plane* source_plane, double rounding) {
    const double facing = dot(pane.n, pane.corners[0] - at.x);
    if (std::abs(facing) <= rounding) return {};
    std::vector<Vec3> polygon;
    for (const Point& p : pane.corners) polygon.push_back(p - at.x);
    polygon = cut_above(polygon, at.n);
    if (!polygon.empty() && source_plane) polygon = cut_above(polygon, source_plane->n, source_plane->offset);
    std::vector<Vec3> planes;
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const Vec3 &a = polygon[i], &b = polygon[i + 1 == m ? 0 : i + 1];
        const Vec3 inward = cross(a, b) * std::copysign(1.0, facing);
        if (norm(inward) > edge_on_sine * norm(a) * norm(b)) planes.push_back(normalized(inward));
    }
    if (planes.size() < 3) planes.clear();
    return planes;
}

/// Position of a convex polygon relative to a pyramid: outside it, inside it, or crossing its sides.
enum class Position { outside, inside, crossing };
Position position_of(std::span<const Vec3> corners, std::span<const Vec3> pyramid) {
    bool is_inside = true;
    for (const Vec3& plane : pyramid) {
        bool any_in = false;
        for (const Vec3& r : corners) {
            const double h = dot(plane, r), rounding = zero_sine * norm(r);
            any_in |= h > rounding, is_inside &= h >= -rounding;
        }
        if (!any_in) return Position::outside;
    }
    return is_inside ? Position::inside : Position::crossing;
}

/// Cuts the parts along a pane's outline and records the pane for the parts behind it.
void cut_along(const Pane& pane, std::span<const Vec3> pyramid, std::vector<Part>& parts) {
    std::vector<Part> fresh;
    for (Part& part : parts) {
        const Position position = position_of(part.corners, pyramid);
        if (position == Position::inside) part.panes.push_back(&pane);
        if (position != Position::crossing) continue;
        std::vector<Vec3> inside = part.corners;
        const std::size_t first = fresh.size();
        for (const Vec3& plane : pyramid) {
            const auto is_out = [&](const Vec3& r) { return dot(plane, r) < -zero_sine * norm(r); };
            if (std::any_of(inside.begin(), inside.end(), is_out)) {
                std::vector<Vec3> rest = cut_above(inside, -plane);
                if (!rest.empty()) fresh.push_back({std::move(rest), part.panes});
                inside = cut_above(inside, plane);
            }
            if (inside.empty()) break;
        }
        if (inside.empty()) {  // this pyramid does not reach the part
            fresh.resize(first);
            continue;
        }
        part.corners = std::move(inside);
        part.panes.push_back(&pane);
    }
    for (Part& part : fresh) parts.push_back(std::move(part));
}

Spectrum transmission_towards(const Vec3& r, std::span<const Pane* const> panes) {
    const Vec3 w = normalized(r);
    Spectrum out(1.0);
    for (const Pane* pane : panes) out *= pane->transmission(std::abs(dot(pane->n, w)));
    return out;
}

Vec3 middle_of(std::span<const Vec3> corners) {
    Vec3 sum;
    for (const Vec3& r : corners) sum += r;
    return sum / static_cast<double>(corners.size());
}

/// Returns whether its area is zero except for rounding.
bool is_sliver(std::span<const Vec3> corners) {
    Vec3 area;
    double reach = 0;
    for (std::size_t i = 2; i < corners.size(); ++i)
        area += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    for (const Vec3& r : corners) reach = std::max(reach, squared_norm(r));
    return !(norm(area) > rounded_sine * reach);
}

/// Sums T p F over parts of a source.
class GlazedSum {
  public:
    GlazedSum(const Normal& n, const RelativeRadiance& radiance) : n_(n), radiance_(radiance) {}

    Spectrum of(std::span<const Vec3> corners, std::span<const Pane* const> panes, int depth = 0) const {
        constexpr int max_depth = 7;
        // Derived from an error of 1e-3 (glazed_form_factor), since quadratic functions are integrated exactly.
        constexpr double max_variation = 0.04;
        if (is_sliver(corners)) return {};
        if (panes.empty()) return Spectrum(form_factor(corners));
        const Vec3 middle = middle_of(corners);
        const Spectrum at_middle = transmission_towards(middle, panes);
        Spectrum least = at_middle, most = at_middle, T;
        double of_corners = 0;
        for (const Vec3& r : corners) {
            const Spectrum here = transmission_towards(r, panes);
            const double weight = kernel(r);
            for (std::size_t b = 0; b < bands; ++b)
                least[b] = std::min(least[b], here[b]), most[b] = std::max(most[b], here[b]);
            T += weight * here, of_corners += weight;
        }
        bool is_even = true;
        for (std::size_t b = 0; b < bands; ++b) is_even = is_even && most[b] - least[b] <= max_variation * most[b];
        if (is_even || depth == max_depth) {
            // Mean of the transmission, weighted by the kernel: each of the n corners counts once, the middle 3 n
            // times. On a triangle, these weights (1 : 1 : 1 : 9) integrate quadratic functions exactly.
            const double share = 3 * static_cast<double>(corners.size()) * kernel(middle);
            if (!(of_corners + share > 0)) return {};
            return form_factor(corners) * ((T + share * at_middle) / (of_corners + share));
        }
        Vec3 along;
        double widest = -1;
        const std::size_t m = corners.size();
        for (std::size_t i = 0; i < m; ++i) {
            const Vec3 &a = corners[i], &b = corners[(i + 1) % m];
            if (const double l = squared_norm(b - a); l > widest) widest = l, along = b - a;
        }
        along = along / std::sqrt(widest);
        const double half = dot(along, middle);
        Spectrum sum;
        for (const double side : {1.0, -1.0})
            if (const std::vector<Vec3> part = cut_above(corners, side * along, side * half); !part.empty())
                sum += of(part, panes, depth + 1);
        return sum;
    }

  private:
    /// Contribution to the form factor per unit of area of the source, except for a constant factor.
    double kernel(const Vec3& r) const {
        const double squared = squared_norm(r), p = radiance_.is_directed() ? radiance_(-r / std::sqrt(squared)) : 1;
        return p * std::max(0.0, dot(n_, r)) / (squared * squared);
    }
    double form_factor(std::span<const Vec3> corners) const {
        return radiance_.is_directed() ? directed_form_factor(n_, corners, radiance_)
                                       : std::max(0.0, contour_sum(n_, corners));
    }

    const Normal& n_;
    const RelativeRadiance& radiance_;
};

/// A pane and the pyramid over it.
struct PaneInView {
    const Pane* pane;
    std::vector<Vec3> pyramid;
};

/// The panes between a receiver and a source. `height`: offset of the source's plane along its normal n, relative to
/// the receiver.
std::vector<PaneInView> panes_in_view(const Occluders& occluders, const SurfacePoint& at, const Normal& n,
                                      double height) {
    std::vector<PaneInView> out;
    const double slack = occluders.rounding();
    const Plane source_plane{n, height + slack};
    for (const Pane& pane : occluders.scene().panes())
        if (std::vector<Vec3> pyramid = pyramid_over(pane, at, &source_plane, slack); !pyramid.empty())
            out.push_back({&pane, std::move(pyramid)});
    return out;
}

/// The panes that light through a window has to pass on its way to a receiver, on either side of the window.
std::vector<PaneInView> panes_besides(const Occluders& occluders, const SurfacePoint& at, PieceId window) {
    std::vector<PaneInView> out;
    std::vector<Vec3> corners;
    for (const Point& p : occluders.corners(window)) corners.push_back(p - at.x);
    for (const Pane& pane : occluders.enclosure().others)
        if (std::vector<Vec3> pyramid = pyramid_over(pane, at, nullptr, occluders.rounding());
            !pyramid.empty() && position_of(corners, pyramid) != Position::outside)
            out.push_back({&pane, std::move(pyramid)});
    return out;
}

/// Cuts a visible polygon along the outlines of panes.
std::vector<Part> parts_behind(std::span<const PaneInView> panes, std::span<const Vec3> visible) {
    std::vector<Part> parts(1);
    parts[0].corners.assign(visible.begin(), visible.end());
    for (const PaneInView& in_view : panes) cut_along(*in_view.pane, in_view.pyramid, parts);
    return parts;
}

Spectrum through_panes(const SurfacePoint& at, std::span<const PaneInView> panes, std::span<const Vec3> visible,
                       const RelativeRadiance& radiance) {
    if (visible.size() < 3 || is_sliver(visible)) return {};
    const GlazedSum sum(at.n, radiance);
    Spectrum out;
    for (const Part& part : parts_behind(panes, visible)) out += sum.of(part.corners, part.panes);
    return out;
}

}  // namespace

Spectrum transmitted_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                                 std::span<const Vec3> visible, const RelativeRadiance& radiance) {
    if (visible.size() < 3) return {};
    const Normal& n = occluders.pieces()[source].plane.n;
    return through_panes(at, panes_in_view(occluders, at, n, dot(n, visible[0])), visible, radiance);
}

Spectrum glazed_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                            std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                            const PartLight& light) {
    // Every fragment is cut along the panes in view and integrated; the search tests every pane. Derived from the time
    // of that test, about 20 ns.
    constexpr double work_of_pane = 0.1;
    const bool is_window = occluders.is_window(source);
    std::vector<PaneInView> panes;
    if (is_window) {
        panes = panes_besides(occluders, at, source);
        scratch.work += work_of_pane * static_cast<double>(occluders.enclosure().others.size());
        if (panes.empty())
            return Spectrum(candidates ? visible_form_factor(occluders, at, source, *candidates, scratch, light)
                                       : visible_form_factor(occluders, at, source, scratch, light));
    }
    Fragments fragments;
    visible_fragments(occluders, at, source, candidates, scratch, fragments);
    if (fragments.empty()) return {};
    scratch.work += VisibilityWorkspace::work_of_integral * static_cast<double>(fragments.size());
    if (!is_window) scratch.work += work_of_pane * static_cast<double>(occluders.scene().panes().size());
    if (scratch.gave_up()) return {};
    const Normal& n = occluders.pieces()[source].plane.n;
    if (!is_window) panes = panes_in_view(occluders, at, n, dot(n, fragments[0][0]));
    Spectrum out;
    for (const std::vector<Vec3>& fragment : fragments) out += through_panes(at, panes, fragment, light.radiance);
    return out;
}

bool crosses(const Pane& pane, const Point& x, const Point& y) {
    const double here = dot(pane.n, x - pane.corners[0]), there = dot(pane.n, y - pane.corners[0]);
    if (here * there >= 0) return false;
    const Vec3 d = y - x;
    bool left = false, right = false;
    for (std::size_t i = 0, m = pane.corners.size(); i < m; ++i) {
        const double side = dot(d, cross(pane.corners[i] - x, pane.corners[i + 1 == m ? 0 : i + 1] - x));
        left |= side > 0, right |= side < 0;
    }
    return !(left && right);
}

Spectrum transmission_between(std::span<const Pane> panes, const Point& x, const Point& y) {
    Spectrum out(1.0);
    const Vec3 d = y - x;
    for (const Pane& pane : panes)
        if (crosses(pane, x, y)) out *= pane.transmission(std::abs(dot(pane.n, d)) / norm(d));
    return out;
}

void add_form_factors_through(const PaneGroups& groups, const Occluders& occluders, const SurfacePoint& at,
                              PieceId source, std::span<const Vec3> visible, std::span<Spectrum> out) {
    if (visible.size() < 3 || is_sliver(visible)) return;
    const Normal& n = occluders.pieces()[source].plane.n;
    const RelativeRadiance diffuse;
    const GlazedSum sum(at.n, diffuse);
    const std::vector<PaneInView> panes = panes_in_view(occluders, at, n, dot(n, visible[0]));
    for (const Part& part : parts_behind(panes, visible)) {
        PaneGroups::Mask crossed = groups.has_all_light() ? 1 : 0;
        for (const Pane* pane : part.panes)
            crossed |= groups.mask_of(static_cast<std::size_t>(pane - occluders.scene().panes().data()));
        if (crossed == 0) continue;
        const Spectrum F = sum.of(part.corners, part.panes);
        for (std::size_t g = 0; g < groups.count(); ++g)
            if (crossed >> g & 1) out[g] += F;
        if (!std::has_single_bit(crossed)) out[groups.count()] += F;
    }
}

}  // namespace exitance

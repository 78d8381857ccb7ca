#include "exitance/visibility/visible_part.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/form_factors/directed_form_factor.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/edge_sum.hpp"
#include "exitance/visibility/glazed_part.hpp"
#include "exitance/visibility/pyramid.hpp"
#include "exitance/visibility/sky/far_factor.hpp"
#include "exitance/visibility/window_view.hpp"

namespace exitance {
namespace {

using Workspace = VisibilityWorkspace;

/// Appends the part of a convex polygon with heights[i] >= 0. For either sign the cut points are identical.
void cut_above(std::span<const Vec3> polygon, std::span<const double> heights, std::vector<Vec3>& out) {
    for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
        const std::size_t j = i + 1 == m ? 0 : i + 1;
        const double a = heights[i], b = heights[j];
        if (a >= 0) out.push_back(polygon[i]);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const bool forward = a < b;
            const Vec3 &p = forward ? polygon[i] : polygon[j], &q = forward ? polygon[j] : polygon[i];
            const double hp = forward ? a : b, hq = forward ? b : a;
            out.push_back(p + (hp / (hp - hq)) * (q - p));
        }
    }
}

/// Keeps the part of `polygon` with n . r >= offset.
void clip_in_place(std::vector<Vec3>& polygon, const Normal& n, double offset, Workspace& scratch) {
    bool any_below = false;
    scratch.heights.clear();
    for (const Vec3& r : polygon) {
        scratch.heights.push_back(dot(n, r) - offset);
        any_below |= scratch.heights.back() < 0;
    }
    if (!any_below) return;
    scratch.side.clear();
    cut_above(polygon, scratch.heights, scratch.side);
    if (scratch.side.size() < 3) scratch.side.clear();
    std::swap(polygon, scratch.side);
}

/// Stores in scratch.source the source relative to x, clipped to x's horizon; empty if none of it can be visible.
void look_at_source(const Occluders& occluders, const SurfacePoint& at, PieceId source, Workspace& scratch) {
    scratch.source.clear();
    const ConvexPiece& piece = occluders.pieces()[source];
    const std::span<const Point> corners = occluders.corners(source);
    if (dot(piece.plane.n, at.x - corners[0]) <= occluders.rounding()) return;
    if (occluders.lie_in_one_plane(at.x, at.n, source)) return;
    const bool is_far = occluders.is_distant(source) && !occluders.is_window(source);
    const Point& from = is_far ? occluders.middle() : at.x;
    for (const Point& p : corners) scratch.source.push_back(p - from);
    clip_in_place(scratch.source, at.n, 0, scratch);
}

/// Stores in scratch.source_pyramid the side planes of the pyramid from x over the source.
void make_pyramid(Workspace& scratch) {
    scratch.source_pyramid.clear();
    for (std::size_t i = 0, m = scratch.source.size(); i < m; ++i) {
        const Vec3 &a = scratch.source[i], &b = scratch.source[i + 1 == m ? 0 : i + 1];
        const Vec3 inward = cross(b - a, a);
        const double length = norm(inward);
        if (length > edge_on_sine * norm(a) * norm(b)) scratch.source_pyramid.push_back(inward / length);
    }
}

/// Stores in scratch.region the pyramid from x over the source, bounded by the receiver's and the source's planes. For
/// a window with faces outside it continues past the pane.
void make_region(const Occluders& occluders, const SurfacePoint& at, PieceId source, Workspace& scratch) {
    const double slack = occluders.rounding();
    const auto above = [&](const Vec3& n, double height) { return Plane{n, dot(n, at.x) + height}; };
    scratch.region.clear();
    const Normal& ns = occluders.pieces()[source].plane.n;
    if (!looks_out_on_faces(occluders, source)) scratch.region.add(above(ns, dot(ns, scratch.source[0]) + slack));
    scratch.region.add(above(at.n, slack));
    for (const Vec3& inward : scratch.source_pyramid) scratch.region.add(above(inward, -slack));
}

/// Part of the source that an occluder's pyramid hides.
enum class Hides { nothing, some, everything };
Hides compare(std::span<const Vec3> source, std::span<const Vec3> planes) {
    bool everything = true;
    for (const Vec3& plane : planes) {
        bool any_in = false;
        for (const Vec3& r : source) {
            const double h = dot(plane, r), noise = rounded_sine * (std::abs(r.x) + std::abs(r.y) + std::abs(r.z));
            any_in |= h > noise;
            everything &= h >= -noise;
        }
        if (!any_in) return Hides::nothing;
    }
    return everything ? Hides::everything : Hides::some;
}

/// Approximate solid angle of a polygon (relative to x), accurate if it is small. distance_of_plane: distance of x from
/// the polygon's plane, metres, with either sign.
double rough_solid_angle(std::span<const Vec3> polygon, double distance_of_plane) {
    Vec3 twice_area, sum;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice_area += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    for (const Vec3& r : polygon) sum += r;
    const double distance = norm(sum) / static_cast<double>(polygon.size());
    return 0.5 * std::abs(distance_of_plane) * norm(twice_area) / (distance * distance * distance);
}

/// Returns whether a region of several pieces (such as a wall with a door) hides the whole source.
bool region_hides_everything(const Occluders& occluders, const SurfacePoint& at, RegionId region, Workspace& scratch) {
    if (std::find(scratch.uncovering.begin(), scratch.uncovering.end(), region) != scratch.uncovering.end())
        return false;
    scratch.cover.begin(occluders.scene().regions()[region], occluders.rounding());
    bool all_cross = true;
    for (const Vec3& r : scratch.source) all_cross = all_cross && scratch.cover.add(at.x, at.x + r);
    if (all_cross && scratch.cover.covers()) return true;
    scratch.uncovering.push_back(region);
    return false;
}

/// Returns how much of the source a candidate hides. If it is some of it, adds the pyramid over the part of the
/// candidate between the planes of the source and the receiver to the shadows. `all_the_way`: the source is a window,
/// and pieces behind its pane hide it, too.
Hides add_shadow(const Occluders& occluders, const SurfacePoint& at, const ConvexPiece& source, bool all_the_way,
                 PieceId candidate, Workspace& scratch) {
    const ConvexPiece& piece = occluders.pieces()[candidate];
    ++scratch.work;
    if (occluders.is_own(piece.region, at.region) || piece.region == source.region) return Hides::nothing;
    const std::span<const Point> corners = occluders.corners(candidate);
    const double facing = dot(piece.plane.n, at.x - corners[0]);
    if (std::abs(facing) <= occluders.rounding()) return Hides::nothing;  // seen edge-on
    const double source_height = dot(source.plane.n, scratch.source[0]);
    double highest = -HUGE_VAL, lowest = HUGE_VAL, nearest = -HUGE_VAL, farthest = HUGE_VAL;
    scratch.clipped.clear();
    for (const Point& p : corners) {
        const Vec3 r = p - at.x;
        const double over_horizon = dot(at.n, r), over_source = dot(source.plane.n, r) - source_height;
        highest = std::max(highest, over_horizon), lowest = std::min(lowest, over_horizon);
        nearest = std::max(nearest, over_source), farthest = std::min(farthest, over_source);
        scratch.clipped.push_back(r);
    }
    const bool is_in_plane = nearest <= piece.thickness && (!all_the_way || farthest >= -piece.thickness);
    if (highest <= occluders.rounding() || is_in_plane) return Hides::nothing;
    for (const Vec3& inward : scratch.source_pyramid) {
        double inmost = -HUGE_VAL;
        for (const Vec3& r : scratch.clipped) inmost = std::max(inmost, dot(inward, r));
        if (inmost <= 0) return Hides::nothing;
    }
    if (farthest < 0 && !all_the_way) clip_in_place(scratch.clipped, source.plane.n, source_height, scratch);
    if (lowest < 0) clip_in_place(scratch.clipped, at.n, 0, scratch);
    if (scratch.clipped.size() < 3) return Hides::nothing;
    const std::size_t first = scratch.planes.size();
    if (!add_pyramid(scratch.clipped, facing, scratch.planes)) return Hides::nothing;
    const Hides hides = compare(scratch.source, std::span(scratch.planes).subspan(first));
    if (hides == Hides::nothing) scratch.planes.resize(first);
    if (hides != Hides::some) return hides;
    if (occluders.pieces(piece.region).size() > 1 && region_hides_everything(occluders, at, piece.region, scratch))
        return Hides::everything;
    scratch.shadows.push_back(
        {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(scratch.planes.size() - first),
         rough_solid_angle(scratch.clipped, facing), static_cast<std::uint32_t>(scratch.outlines.size()), facing < 0});
    scratch.outlines.corners.insert(scratch.outlines.corners.end(), scratch.clipped.begin(), scratch.clipped.end());
    scratch.outlines.close();
    return hides;
}

/// Subtracts the shadows from index `first` on from the lit part. Returns false if nothing is left.
bool cut_lit(std::size_t first, Workspace& scratch) {
    // Large shadows first: they may leave nothing for the others to cut. Ties are resolved by position, so that the
    // order is reproducible.
    std::sort(scratch.shadows.begin() + static_cast<std::ptrdiff_t>(first), scratch.shadows.end(),
              [](const Workspace::Shadow& a, const Workspace::Shadow& b) {
                  return a.solid_angle != b.solid_angle ? a.solid_angle > b.solid_angle : a.first_plane < b.first_plane;
              });
    if (first == 0) scratch.lit.begin(scratch.source);
    for (std::size_t k = first; k < scratch.shadows.size(); ++k) {
        const Workspace::Shadow& shadow = scratch.shadows[k];
        const std::span<const Vec3> planes = std::span(scratch.planes).subspan(shadow.first_plane, shadow.plane_count);
        if (!scratch.lit.cut(planes, scratch.lit.bounds(scratch.outlines[shadow.outline]))) return false;
        scratch.work += static_cast<double>(scratch.lit.size());
        if (scratch.gave_up()) return false;
    }
    return true;
}

/// Form factor of the unoccluded source, weighted by its radiance. For a part of the sky it depends only on the normal
/// and is cached.
double whole_form_factor(const Occluders& occluders, PieceId source, const Normal& n, Workspace& scratch,
                         const RelativeRadiance& radiance) {
    if (!occluders.is_distant(source) || occluders.is_window(source))
        return directed_form_factor(n, scratch.source, radiance);
    double& known = known_far_factor(occluders, source, n);
    // Count the work even if the result is known, so that the count does not depend on earlier calls.
    scratch.work += Workspace::work_of_integral;
    if (known < 0) known = directed_form_factor(n, scratch.source, radiance);
    return known;
}

/// Returns `f`, the form factor to the visible part of the source; 0 if that part is so small that it may be a sliver
/// which rounding leaves between two adjacent shadows.
double without_rounding(double f, const Normal& n, std::span<const Vec3> source) {
    constexpr double certain = 1e-9;         // derived from rounding: larger factors never come from it
    constexpr double rounded_share = 1e-12;  // derived from double precision: four digits more than its rounding
    return f <= certain && f <= rounded_share * contour_sum(n, source) ? 0 : f;
}

/// Form factor to the visible part after all shadows. The first `cut` shadows have been subtracted already. If
/// `fragments` is given, appends the visible fragments to it instead and returns 0.
double finish(const Occluders& occluders, PieceId source, const Normal& n, std::size_t cut, Workspace& scratch,
              const PartLight& light, Fragments* fragments) {
    if (fragments) {
        if (scratch.shadows.empty()) {
            fragments->push_back(scratch.source);
        } else if (cut_lit(cut, scratch)) {
            for (std::size_t i = 0; i < scratch.lit.size(); ++i) scratch.lit.corners(i, fragments->emplace_back());
        }
        return 0;
    }
    if (light.radiance.is_directed()) {
        if (scratch.shadows.empty()) return whole_form_factor(occluders, source, n, scratch, light.radiance);
        if (!cut_lit(cut, scratch)) return 0;
        scratch.work += Workspace::work_of_integral * static_cast<double>(scratch.lit.size());
        if (light.radiance.is_picture()) scratch.work += work_of_picture;
        if (scratch.gave_up()) return 0;
        return without_rounding(scratch.lit.form_factor(n, light.radiance, scratch.clipped), n, scratch.source);
    }
    if (scratch.shadows.empty()) return std::max(0.0, contour_sum(n, scratch.source));
    if (light.method == VisiblePartMethod::edge_sums) {
        const double f = edge_sum(n, scratch);
        if (!std::isnan(f)) return std::clamp(f, 0.0, 1.0);
        cut = 0;
    }
    return cut_lit(cut, scratch) ? without_rounding(scratch.lit.form_factor(n), n, scratch.source) : 0;
}

void clear_shadows(Workspace& scratch) {
    scratch.planes.clear();
    scratch.shadows.clear();
    scratch.outlines.clear();
    scratch.uncovering.clear();
}

/// Form factor to the visible part of scratch.source, with occluders from the tree.
double part_among_all(const Occluders& occluders, const SurfacePoint& at, PieceId source, VisibilityWorkspace& scratch,
                      const PartLight& light, Fragments* fragments = nullptr) {
    clear_shadows(scratch);
    if (scratch.source.empty()) return 0;
    // Surfaces on the scene's hull never occlude.
    const bool in_scene = !at.region.is_none() && !occluders.is_distant(source);
    if (in_scene && occluders.has_nothing_inside())
        return finish(occluders, source, at.n, 0, scratch, light, fragments);
    make_pyramid(scratch);
    const ConvexPiece& emitter = occluders.pieces()[source];
    const bool all_the_way = looks_out_on_faces(occluders, source);
    PieceId& likely = scratch.last_blocker(occluders, source);
    const auto hides_everything = [&](PieceId p) {
        const bool hides = add_shadow(occluders, at, emitter, all_the_way, p, scratch) == Hides::everything;
        if (hides) likely = p;
        return hides || scratch.gave_up();
    };
    // With limited work the search is always the same: otherwise earlier calls would decide whether it ends in time.
    if (!likely.is_none() && scratch.max_work == HUGE_VAL) {
        if (hides_everything(likely)) return 0;
        scratch.planes.clear();
        scratch.shadows.clear();
        scratch.outlines.clear();
    }
    make_region(occluders, at, source, scratch);
    const auto visit = [&](Occluders::Size size) {  // front to back from the receiver: near walls hide most
        return in_scene ? occluders.visit_inner(size, scratch.region, hides_everything, scratch.source[0])
                        : occluders.visit_region(size, scratch.region, hides_everything, scratch.source[0]);
    };
    if (visit(Occluders::Size::large)) return 0;
    const std::size_t large = scratch.shadows.size();
    // several large pieces together hide the source, so small pieces are irrelevant
    if (large > 1 && !cut_lit(0, scratch)) return 0;
    if (visit(Occluders::Size::small)) return 0;
    return finish(occluders, source, at.n, large > 1 ? large : 0, scratch, light, fragments);
}

double part_among(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                  std::span<const PieceId> candidates, VisibilityWorkspace& scratch, const PartLight& light,
                  Fragments* fragments = nullptr) {
    clear_shadows(scratch);
    if (scratch.source.empty()) return 0;
    if (candidates.empty()) return finish(occluders, source, at.n, 0, scratch, light, fragments);
    make_pyramid(scratch);
    const ConvexPiece& emitter = occluders.pieces()[source];
    const bool all_the_way = looks_out_on_faces(occluders, source);
    for (PieceId p : candidates)
        if (add_shadow(occluders, at, emitter, all_the_way, p, scratch) == Hides::everything || scratch.gave_up())
            return 0;
    return finish(occluders, source, at.n, 0, scratch, light, fragments);
}

}  // namespace

double visible_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                           VisibilityWorkspace& scratch, const PartLight& light) {
    ++scratch.work;
    if (scratch.gave_up()) return 0;
    look_at_source(occluders, at, source, scratch);
    return part_among_all(occluders, at, source, scratch, light);
}

double visible_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                           std::span<const PieceId> candidates, VisibilityWorkspace& scratch, const PartLight& light) {
    look_at_source(occluders, at, source, scratch);
    return part_among(occluders, at, source, candidates, scratch, light);
}

void visible_fragments(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                       std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                       Fragments& out) {
    out.clear();
    ++scratch.work;
    if (scratch.gave_up()) return;
    look_at_source(occluders, at, source, scratch);
    if (candidates)
        part_among(occluders, at, source, *candidates, scratch, {}, &out);
    else
        part_among_all(occluders, at, source, scratch, {}, &out);
}

}  // namespace exitance

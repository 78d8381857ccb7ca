#include "exitance/view_factors/hidden_parts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/visibility/narrow_gaps.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {
namespace {

constexpr double min_width = 16;  ///< Width of a part, in units of the slack; derived from the rounding of corners.
constexpr std::size_t max_corners = 12;  ///< Limit on the corners of a convex piece.
/// Number of rays that decide whether the space in front of a face is inside a body. A choice.
constexpr std::size_t probing_rays = 64;

Box everywhere() {
    Box box;
    box.lo = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, box.hi = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    return box;
}

Box grown(const Box& box, double by) {
    Box out = box;
    out.lo = box.lo - Vec3{by, by, by}, out.hi = box.hi + Vec3{by, by, by};
    return out;
}

bool overlap(const Box& a, const Box& b, double slack) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.lo[k] > b.hi[k] + slack || b.lo[k] > a.hi[k] + slack) return false;
    return true;
}

bool is_negligible(std::span<const Point> outline, double slack) {
    if (outline.size() < 3) return true;
    Box box;
    for (const Point& p : outline) box.add(p);
    return norm(area_vector(outline)) <= min_width * slack * box.diagonal();
}

/// Returns the plane through an edge and perpendicular to the polygon's plane, with the polygon in front.
Plane side_plane(const Point& a, const Point& b, const Normal& n) {
    const Normal inwards = normalized(cross(n, b - a));
    return {inwards, dot(inwards, a)};
}

/// Intersection of two convex polygons with normal n.
std::vector<Point> intersection(std::vector<Point> polygon, std::span<const Point> other, const Normal& n) {
    std::vector<Point> next;
    for (std::size_t i = 0; i < other.size() && polygon.size() >= 3; ++i) {
        const Point &a = other[i], &b = other[(i + 1) % other.size()];
        if (!(norm(b - a) > 0)) continue;
        clip(polygon, side_plane(a, b, n), next);
        polygon.swap(next);
    }
    return polygon;
}

void add_piece(const std::vector<Point>& polygon, std::vector<std::vector<Point>>& pieces) {
    for (std::size_t first = 1; first + 1 < polygon.size(); first += max_corners - 2) {
        std::vector<Point>& part = pieces.emplace_back();
        part.push_back(polygon[0]);
        for (std::size_t k = first; k < polygon.size() && k < first + max_corners - 1; ++k) part.push_back(polygon[k]);
    }
}

/// Adds the parts of a convex polygon outside another one.
void subtract(const std::vector<Point>& polygon, std::span<const Point> hole, const Normal& n, double slack,
              std::vector<std::vector<Point>>& pieces) {
    if (is_negligible(intersection(polygon, hole, n), slack)) {
        pieces.push_back(polygon);
        return;
    }
    std::vector<Point> rest = polygon, out, next;
    for (std::size_t i = 0; i < hole.size() && rest.size() >= 3; ++i) {
        const Point &a = hole[i], &b = hole[(i + 1) % hole.size()];
        if (!(norm(b - a) > 0)) continue;
        const Plane inside = side_plane(a, b, n);
        clip(rest, {-inside.n, -inside.offset}, out);
        if (!is_negligible(out, slack)) add_piece(out, pieces);
        clip(rest, inside, next);
        rest.swap(next);
    }
}

/// True if two regions have equal outlines, so that they may be the two sides of a sheet.
bool have_equal_outlines(const Region& a, const Region& b, double rounding) {
    if (std::abs(a.area - b.area) > coplanar_share * a.area || a.loops.empty() || b.loops.empty()) return false;
    Box p, q;
    for (const Point& x : a.loops[0]) p.add(x);
    for (const Point& x : b.loops[0]) q.add(x);
    const double tolerance = coplanar_share * p.diagonal() + rounding;
    return norm(p.lo - q.lo) <= tolerance && norm(p.hi - q.hi) <= tolerance;
}

/// Tests whether a point in front of a face is inside a body, where most rays meet backs of faces first.
class InsideTest {
  public:
    explicit InsideTest(const Scene& scene) : scene_(scene) {}
    bool operator()(const Point& x, SurfaceId face) {
        if (!tracer_) tracer_ = std::make_unique<RayTracer>(scene_);
        const ScrambledSobol points(face.value);
        const Frame frame(scene_.surfaces()[face].normal);
        std::vector<Vec3> directions(probing_rays);
        std::vector<RayHit> hits(probing_rays);
        for (std::uint32_t k = 0; k < probing_rays; ++k)
            directions[k] = cosine_direction(frame, points(k, 0), points(k, 1));
        tracer_->nearest(directions, x, scene_.surfaces()[face].region, hits);
        const auto backs =
            std::count_if(hits.begin(), hits.end(), [](const RayHit& h) { return !h.surface.is_none() && !h.front; });
        return 2 * static_cast<std::size_t>(backs) > probing_rays;
    }

  private:
    const Scene& scene_;
    std::unique_ptr<RayTracer> tracer_;
};

/// True if parts of either face are on both sides of the other's plane.
bool may_cross(const ViewFace& a, const ViewFace& b, double slack) {
    const auto is_cut = [&](const ViewFace& face, const Plane& plane) {
        bool above = false, below = false;
        for (const Point& p : face.outline) {
            const double d = plane.signed_distance(p);
            above |= d > slack, below |= d < -slack;
        }
        return above && below;
    };
    return is_cut(a, b.plane) && is_cut(b, a.plane);
}

/// Finds whether and where one face covers another.
class Covers {
  public:
    explicit Covers(const Occluders& occluders) : occluders_(occluders), scene_(occluders.scene()) {}

    /// Parts of face a that face b covers, like Occluders::is_covered(). `is_equal` is set if both have the same
    /// outline and opposite directions, so that they may also be the two sides of a sheet.
    std::vector<std::vector<Point>> operator()(const ViewFace& a, std::uint32_t i, const ViewFace& b, std::uint32_t j,
                                               double slack, bool& is_equal) const {
        const RegionId own = region(i), other = region(j);
        std::vector<std::vector<Point>> parts;
        if (own == other) return parts;
        const double cosine = dot(a.plane.n, b.plane.n), thickness = std::max(occluders_.rounding(), 0.5 * b.thickness);
        if (std::abs(cosine) < parallel_cosine) return parts;
        const double near = 2 * thickness;
        if (!is_within(b.outline, a.plane, near) && !is_within(a.outline, b.plane, near)) return parts;
        is_equal =
            cosine < 0 && (occluders_.is_own(other, own) ||
                           have_equal_outlines(scene_.regions()[own], scene_.regions()[other], occluders_.rounding()));
        const double raised = occluders_.lift(other) - occluders_.lift(own);
        for (const std::vector<Point>& piece : b.pieces) {
            std::vector<Point> flat;
            double height = 0;
            for (const Point& p : piece) {
                const double d = a.plane.signed_distance(p);
                height += d / static_cast<double>(piece.size());
                flat.push_back(p - d * a.plane.n);
            }
            if (std::abs(height) > near || (cosine > 0 && height + raised <= occluders_.rounding())) continue;
            if (cosine < 0) std::reverse(flat.begin(), flat.end());
            for (const std::vector<Point>& of_a : a.pieces) {
                std::vector<Point> both = intersection(of_a, flat, a.plane.n);
                if (!is_negligible(both, slack)) parts.push_back(std::move(both));
            }
        }
        return parts;
    }

  private:
    RegionId region(std::uint32_t face) const { return scene_.surfaces()[SurfaceId(face)].region; }
    const Occluders& occluders_;
    const Scene& scene_;
};

/// The part of a convex piece of a face that is inside a solid; empty if the solid only touches the face.
std::vector<Point> section(const std::vector<Point>& piece, const Plane& plane, const ConvexBlocker& solid,
                           double slack) {
    std::vector<Point> inside = piece, next;
    for (const Plane& side : solid.faces) {
        clip(inside, {-side.n, -side.offset}, next);
        inside.swap(next);
        if (inside.size() < 3) return {};
    }
    return is_negligible(inside, slack) || dot(area_vector(inside), plane.n) <= 0 ? std::vector<Point>() : inside;
}

bool crosses(const ConvexBlocker& solid, const Plane& plane, double slack) {
    bool above = false, below = false;
    for (const Point& p : solid.points) {
        const double d = plane.signed_distance(p);
        above |= d > slack, below |= d < -slack;
    }
    return above && below;
}

}  // namespace

HiddenParts::HiddenParts(const Occluders& occluders, std::span<const ViewFace> faces, double slack)
    : faces_(faces), slack_(slack), parts_(faces.size()), is_met_(faces.size()) {
    std::vector<Box> boxes;
    boxes.reserve(faces.size());
    for (const ViewFace& face : faces) boxes.push_back(face.box);
    const Bvh tree(boxes);
    add_covers(occluders, tree);
    std::vector<std::uint8_t> is_crossed(faces.size());
    parallel_for(faces.size(), 16, [&](std::size_t i) {
        tree.visit_box(faces[i].box, [&](std::uint32_t j) {
            return j < i && may_cross(faces[i], faces[j], slack) && (is_crossed[i] = 1);
        });
    });
    const bool any_crossed = std::find(is_crossed.begin(), is_crossed.end(), 1) != is_crossed.end();
    const bool any = std::any_of(parts_.begin(), parts_.end(), [](const auto& parts) { return !parts.empty(); });
    if (!any && !any_crossed) {
        parts_.clear(), is_met_.clear();
        return;
    }
    const FaceBodies bodies(faces, slack);
    for (auto& parts : parts_)
        for (HiddenPart& part : parts) {
            // `by_solid` holds for closed bodies unless faces pierce them; add_sections() checks that.
            const FaceBodies::Body& body = bodies.of(part.by);
            const bool is_flat =
                body.box.diagonal() > 0 && std::all_of(body.faces.begin(), body.faces.end(), [&](std::uint32_t k) {
                    return std::abs(dot(faces[k].plane.n, faces[part.by].plane.n)) >= parallel_cosine;
                });
            part.by_solid = body.is_closed && !is_flat;
            part.body = part.by_solid ? body.box : everywhere();
        }
    if (any_crossed) add_sections(occluders, tree, bodies);
    for (std::size_t i = 0; i < faces.size(); ++i)
        is_met_[i] = std::any_of(parts_[i].begin(), parts_[i].end(), [](const HiddenPart& p) { return !p.by_solid; });
    has_uncovered_.resize(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
        has_uncovered_[i] =
            std::any_of(parts_[i].begin(), parts_[i].end(), [](const HiddenPart& p) { return !p.is_covered; });
}

void HiddenParts::add_covers(const Occluders& occluders, const Bvh& tree) {
    const Covers covers(occluders);
    InsideTest is_inside(occluders.scene());
    parallel_for(faces_.size(), 16, [&](std::size_t i) {
        const ViewFace& face = faces_[i];
        std::vector<std::uint32_t> near;
        tree.visit_box(grown(face.box, face.thickness + slack_), [&](std::uint32_t j) {
            if (j != i && std::abs(dot(face.plane.n, faces_[j].plane.n)) >= parallel_cosine) near.push_back(j);
            return false;
        });
        std::sort(near.begin(), near.end());
        for (const std::uint32_t j : near) {
            bool is_equal = false;
            for (auto& outline : covers(face, static_cast<std::uint32_t>(i), faces_[j], j, slack_, is_equal))
                parts_[i].push_back({std::move(outline), {}, !is_equal, true, j});
        }
    });
    for (std::size_t i = 0; i < faces_.size(); ++i)
        std::erase_if(parts_[i], [&](const HiddenPart& part) {
            return !part.is_covered && !is_inside(centroid(part.outline), SurfaceId(static_cast<std::uint32_t>(i)));
        });
}

void HiddenParts::add_sections(const Occluders& occluders, const Bvh& tree, const FaceBodies& bodies) {
    std::vector<ConvexBlocker> solids = make_solid_blockers(occluders, slack_);
    std::erase_if(solids, [&](const ConvexBlocker& solid) { return bodies.has_body_inside(solid, faces_, slack_); });
    std::vector<Box> boxes;
    for (const ConvexBlocker& solid : solids) {
        Box box;
        for (const Point& p : solid.points) box.add(p);
        boxes.push_back(box);
        tree.visit_box(box, [&](std::uint32_t i) {
            if (!crosses(solid, faces_[i].plane, slack_)) return false;
            for (const std::vector<Point>& piece : faces_[i].pieces)
                if (std::vector<Point> inside = section(piece, faces_[i].plane, solid, slack_); !inside.empty())
                    parts_[i].push_back({std::move(inside), box, false, true, i});
            return false;
        });
    }
    // Rays may start inside other closed bodies.
    for (auto& parts : parts_)
        for (HiddenPart& part : parts)
            part.by_solid = std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
                return norm(box.lo - part.body.lo) <= slack_ && norm(box.hi - part.body.hi) <= slack_;
            });
}

bool HiddenParts::contains_uncovered(std::size_t face, const Point& x) const {
    if (!has(face) || !has_uncovered_[face]) return false;
    return std::any_of(parts_[face].begin(), parts_[face].end(), [&](const HiddenPart& part) {
        return !part.is_covered && contains(part.outline, faces_[face].plane.n, x);
    });
}

bool HiddenParts::matters(const HiddenPart& part, const ViewFace& other) const {
    if (!overlap(part.body, other.box, slack_)) return false;
    return std::any_of(part.outline.begin(), part.outline.end(),
                       [&](const Point& p) { return other.plane.signed_distance(p) > slack_; });
}

bool HiddenParts::matter(std::size_t i, std::size_t j) const {
    return has(i) && std::any_of(parts_[i].begin(), parts_[i].end(),
                                 [&](const HiddenPart& part) { return matters(part, faces_[j]); });
}

std::vector<std::vector<Point>> HiddenParts::pieces(std::size_t i, std::size_t j) const {
    std::vector<std::vector<Point>> pieces = faces_[i].pieces, next;
    if (!has(i)) return pieces;
    for (const HiddenPart& part : parts_[i]) {
        if (!matters(part, faces_[j])) continue;
        next.clear();
        for (const std::vector<Point>& piece : pieces) subtract(piece, part.outline, faces_[i].plane.n, slack_, next);
        pieces.swap(next);
    }
    return pieces;
}

}  // namespace exitance

#include "exitance/view_factors/hidden_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/scene/borders.hpp"
#include "exitance/visibility/narrow_gaps.hpp"

namespace exitance {
namespace {

/// Number of rays that decide whether the space in front of a face is inside a solid. A choice.
constexpr std::size_t probing_rays = 64;
constexpr std::size_t faces_a_task = 16;

/// True if points are on both sides of a plane, farther than `slack` from it (metres).
bool is_cut(std::span<const Point> points, const Plane& plane, double slack) {
    bool above = false, below = false;
    for (const Point& p : points) {
        const double d = plane.signed_distance(p);
        above |= d > slack, below |= d < -slack;
    }
    return above && below;
}

/// True if parts of either face are on both sides of the other's plane.
bool may_cross(const ViewFace& a, const ViewFace& b, double slack) {
    return is_cut(a.outline, b.plane, slack) && is_cut(b.outline, a.plane, slack);
}

/// Finds whether and where one face covers another.
class Covers {
  public:
    explicit Covers(const Occluders& occluders) : occluders_(occluders), scene_(occluders.scene()) {}

    /// Parts of face a that face b covers, also if both may be the two sides of a sheet.
    ConvexParts operator()(const ViewFace& a, std::uint32_t i, const ViewFace& b, std::uint32_t j, double slack) const {
        const RegionId own = region(i), other = region(j);
        ConvexParts parts;
        if (own == other) return parts;
        const double cosine = dot(a.plane.n, b.plane.n), thickness = std::max(occluders_.rounding(), 0.5 * b.thickness);
        if (std::abs(cosine) < parallel_cosine) return parts;
        const double near = 2 * thickness;
        if (!is_within(b.outline, a.plane, near) && !is_within(a.outline, b.plane, near)) return parts;
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

    /// True if Occluders::is_covered() recognizes that a part of face i is covered, at its centroid and halfway to its
    /// corners. It does not recognize faces with equal outlines, which may be the two sides of a sheet.
    bool is_recognized(std::span<const Point> part, const Normal& n, std::uint32_t i) const {
        const Point middle = centroid(part);
        return occluders_.is_covered(middle, n, region(i)) &&
               std::all_of(part.begin(), part.end(),
                           [&](const Point& p) { return occluders_.is_covered(0.5 * (middle + p), n, region(i)); });
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

}  // namespace

HiddenParts::HiddenParts(const Occluders& occluders, std::span<const ViewFace> faces, double slack,
                         const StopRequest& stop, const RayTracer* tracer, const FaceGroups* groups)
    : faces_(faces), slack_(slack), found_(faces.size()) {
    std::vector<Box> boxes;
    boxes.reserve(faces.size());
    for (const ViewFace& face : faces) boxes.push_back(face.box);
    const Bvh tree(boxes);
    add_covers(occluders, tree, stop, tracer);
    std::vector<std::uint8_t> is_crossed(faces.size());
    parallel_for(faces.size(), faces_a_task, [&](std::size_t i) {
        if (stop.requested()) return;
        tree.visit_box(faces[i].box, [&](std::uint32_t j) {
            return j < i && may_cross(faces[i], faces[j], slack) && (is_crossed[i] = 1);
        });
    });
    const bool any_crossed = std::find(is_crossed.begin(), is_crossed.end(), 1) != is_crossed.end();
    const bool any = std::any_of(found_.begin(), found_.end(), [](const auto& parts) { return !parts.empty(); });
    if ((any || any_crossed) && !stop.requested()) {
        std::optional<FaceGroups> own_groups;
        if (!groups) groups = &own_groups.emplace(faces, slack);
        for (auto& parts : found_)
            for (HiddenPart& part : parts) {
                // Groups shield what they hide unless faces pierce them; add_sections() checks that.
                const FaceGroup& group = groups->of(part.by);
                part.is_shielded = group.bounds_solid();
                if (part.is_shielded) part.reach = group.box;
            }
        if (any_crossed) add_sections(occluders, tree, *groups);
        finish(stop);
    }
    found_ = {};
}

void HiddenParts::add_covers(const Occluders& occluders, const Bvh& tree, const StopRequest& stop,
                             const RayTracer* tracer) {
    const Covers covers(occluders);
    parallel_for(faces_.size(), faces_a_task, [&](std::size_t i) {
        if (stop.requested()) return;
        const ViewFace& face = faces_[i];
        std::vector<std::uint32_t> near;
        tree.visit_box(grown(face.box, face.thickness + slack_), [&](std::uint32_t j) {
            if (j != i && std::abs(dot(face.plane.n, faces_[j].plane.n)) >= parallel_cosine) near.push_back(j);
        });
        std::sort(near.begin(), near.end());
        for (const std::uint32_t j : near) {
            for (auto& outline : covers(face, static_cast<std::uint32_t>(i), faces_[j], j, slack_)) {
                const bool is_covered = covers.is_recognized(outline, face.plane.n, static_cast<std::uint32_t>(i));
                found_[i].push_back({std::move(outline), {}, is_covered, true, j});
            }
        }
    });
    if (!stop.requested()) drop_sheets(occluders, stop, tracer);
}

/// Tests whether a point in front of a face is inside a solid. Rays from there meet backs of faces, and fronts that
/// other faces cover. Faces with equal outlines do not tell: both the sides of a sheet and two boxes side by side have
/// them.
bool HiddenParts::is_inside(const Occluders& occluders, const RayTracer& tracer, const UncertainPart& part,
                            std::span<const UncertainPart> uncertain) const {
    const Scene& scene = occluders.scene();
    const SurfaceId face(part.face);
    const Point x = centroid(found_[part.face][part.part].outline);
    const ScrambledSobol points(face.value);
    const Frame frame(scene.surfaces()[face].normal);
    std::array<Vec3, probing_rays> directions;
    std::array<RayHit, probing_rays> hits;
    for (std::uint32_t k = 0; k < probing_rays; ++k)
        directions[k] = cosine_direction(frame, points(k, 0), points(k, 1));
    tracer.nearest(directions, x, scene.surfaces()[face].region, hits);
    std::size_t fronts = 0, backs = 0;
    for (std::size_t k = 0; k < probing_rays; ++k) {
        const RayHit& hit = hits[k];
        if (hit.surface.is_none()) {
            ++fronts;
            continue;
        }
        const Surface& surface = scene.surfaces()[hit.surface];
        const Point place = place_of(scene, hit, x, directions[k]);
        bool may_be_sheet = false;
        for (auto other = std::lower_bound(uncertain.begin(), uncertain.end(), hit.surface.value,
                                           [](const UncertainPart&u, std::uint32_t i) { return u.face < i; });
             other != uncertain.end() && other->face == hit.surface.value; ++other)
            may_be_sheet |= contains(found_[other->face][other->part].outline, surface.normal, place);
        if (may_be_sheet) continue;
        ++(!hit.front || occluders.is_covered(place, surface.normal, surface.region) ? backs : fronts);
    }
    return backs > fronts;
}

/// Removes covers between the two sides of a sheet, which hide nothing.
void HiddenParts::drop_sheets(const Occluders& occluders, const StopRequest& stop, const RayTracer* tracer) {
    std::vector<UncertainPart> uncertain;  // sorted by face
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
        for (std::size_t k = 0; k < found_[i].size(); ++k)
            if (!found_[i][k].is_covered) uncertain.push_back({i, k});
    if (uncertain.empty()) return;
    std::optional<RayTracer> own_tracer;
    if (!tracer) tracer = &own_tracer.emplace(occluders.scene());
    std::vector<std::uint8_t> is_hidden(uncertain.size());
    parallel_for(uncertain.size(), faces_a_task, [&](std::size_t k) {
        if (stop.requested()) return;
        is_hidden[k] = is_inside(occluders, *tracer, uncertain[k], uncertain);
    });
    for (std::size_t k = uncertain.size(); k-- > 0;)
        if (!is_hidden[k]) {
            auto& parts = found_[uncertain[k].face];
            parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(uncertain[k].part));
        }
}

void HiddenParts::add_sections(const Occluders& occluders, const Bvh& tree, const FaceGroups& groups) {
    std::vector<ConvexBlocker> solids = make_solid_blockers(occluders, slack_);
    std::erase_if(solids, [&](const ConvexBlocker& solid) { return groups.is_hollow(solid); });
    std::vector<Box> boxes;
    for (const ConvexBlocker& solid : solids) {
        const Box box = box_of(solid.points);
        boxes.push_back(box);
        tree.visit_box(box, [&](std::uint32_t i) {
            if (!is_cut(solid.points, faces_[i].plane, slack_)) return;
            for (const std::vector<Point>& piece : faces_[i].pieces)
                if (std::vector<Point> inside = section(piece, faces_[i].plane, solid, slack_); !inside.empty())
                    found_[i].push_back({std::move(inside), box, false, true, i});
        });
    }
    // Rays may start inside other closed groups.
    const Bvh solid_tree(boxes);
    for (auto& parts : found_)
        for (HiddenPart& part : parts)
            part.is_shielded = part.reach && solid_tree.visit_box(*part.reach, [&](std::uint32_t k) {
                return norm(boxes[k].lo - part.reach->lo) <= slack_ && norm(boxes[k].hi - part.reach->hi) <= slack_;
            });
}

/// Makes the structures by which the parts of a face are found.
void HiddenParts::finish(const StopRequest& stop) {
    numbers_.assign(faces_.size(), none);
    std::vector<std::uint32_t> owners;
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
        if (!found_[i].empty()) numbers_[i] = static_cast<std::uint32_t>(owners.size()), owners.push_back(i);
    faces_with_parts_.resize(owners.size());
    parallel_for(owners.size(), 1, [&](std::size_t k) {
        if (stop.requested()) return;
        const ViewFace& whole = faces_[owners[k]];
        Face& face = faces_with_parts_[k];
        face.parts = std::move(found_[owners[k]]);
        const auto first_limited = std::stable_partition(face.parts.begin(), face.parts.end(),
                                                         [](const HiddenPart& part) { return !part.reach; });
        face.unlimited = static_cast<std::size_t>(first_limited - face.parts.begin());
        std::vector<Box> outlines, reaches;
        std::vector<std::span<const Point>> holes;
        for (const HiddenPart& part : face.parts) {
            outlines.push_back(grown(box_of(part.outline), whole.thickness + slack_));
            if (part.reach)
                reaches.push_back(*part.reach);
            else
                holes.push_back(part.outline);
            face.is_met |= !part.is_shielded, face.has_uncovered |= !part.is_covered;
        }
        face.outlines = Bvh(outlines);
        face.unlimited_outlines = Bvh(std::span(outlines).first(face.unlimited));
        face.reaches = Bvh(reaches);
        if (holes.empty()) return;
        for (const std::vector<Point>& piece : whole.pieces)
            subtract(piece, holes, whole.plane.n, slack_, face.remaining);
    });
}

bool HiddenParts::contains_uncovered(std::size_t i, const Point& x) const {
    const Face* const face = find(i);
    if (!face || !face->has_uncovered) return false;
    Box place;
    place.add(x);
    return face->outlines.visit_box(place, [&](std::uint32_t k) {
        const HiddenPart& part = face->parts[k];
        return !part.is_covered && contains(part.outline, faces_[i].plane.n, x);
    });
}

bool HiddenParts::is_in_front(const HiddenPart& part, const ViewFace& other) const {
    return std::any_of(part.outline.begin(), part.outline.end(),
                       [&](const Point& p) { return other.plane.signed_distance(p) > slack_; });
}

/// True if some part without a reach is in front of another face.
bool HiddenParts::shows_unlimited(const Face& face, const ViewFace& other) const {
    if (face.unlimited == 0) return false;
    ConvexRegion front;
    front.add(other.plane);
    return face.unlimited_outlines.visit_region(front,
                                                [&](std::uint32_t k) { return is_in_front(face.parts[k], other); });
}

/// Calls visit(part) for every part that has a reach, until it returns true.
template <class Visit>
void HiddenParts::visit_limited(const Face& face, const ViewFace& other, const Visit& visit) const {
    face.reaches.visit_box(grown(other.box, slack_), [&](std::uint32_t k) {
        const HiddenPart& part = face.parts[face.unlimited + k];
        return is_in_front(part, other) && visit(part);
    });
}

std::size_t HiddenParts::count_from(std::size_t i, std::size_t j, std::size_t limit) const {
    const Face* const face = find(i);
    if (!face) return 0;
    const ViewFace& other = faces_[j];
    std::size_t count = shows_unlimited(*face, other) ? face->unlimited : 0;
    if (count < limit) visit_limited(*face, other, [&](const HiddenPart&) { return ++count >= limit; });
    return std::min(count, limit);
}

const ConvexParts& HiddenParts::pieces(std::size_t i, std::size_t j, ConvexParts& scratch) const {
    const Face* const face = find(i);
    if (!face) return faces_[i].pieces;
    const ViewFace& other = faces_[j];
    const ConvexParts& whole = shows_unlimited(*face, other) ? face->remaining : faces_[i].pieces;
    std::vector<std::span<const Point>> holes;
    visit_limited(*face, other, [&](const HiddenPart& part) {
        holes.emplace_back(part.outline);
        return false;
    });
    if (holes.empty()) return whole;
    scratch.clear();
    for (const std::vector<Point>& piece : whole) subtract(piece, holes, faces_[i].plane.n, slack_, scratch);
    return scratch;
}

}  // namespace exitance

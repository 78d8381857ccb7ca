#include "exitance/visibility/narrow_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

/// Cosine between normals below which a face is regarded as perpendicular, derived from the strip that the lift misses
/// below it: that share of the lift, about 1e-9 of the scene's size.
constexpr double perpendicular = 1e-3;
/// Share of a face's area from which the points below close faces matter, since rays from them are lost; derived from a
/// fifth of the error 1e-3 of rows of view factors. With 3e-5, solves of furnished rooms take up to 10% longer.
constexpr double negligible_share = 2e-4;
/// Factor on the double precision of the largest coordinate; derived from Occluders::rounding().
constexpr double roundings = 16;

/// Box of a face as rays meet it: `raised` metres above its plane.
Box outline_box(const Scene& scene, SurfaceId s, double raised) {
    const Vec3 up = raised * scene.surfaces()[s].normal;
    Box box;
    for (const Point& p : scene.outline(s)) box.add(p + up);
    return box;
}

bool meet(const Box& a, const Box& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
    return true;
}

/// Plane of a face, `raised` metres above it.
Plane plane_of(const Scene& scene, SurfaceId s, double raised) {
    const Normal& n = scene.surfaces()[s].normal;
    return {n, dot(n, scene.outline(s)[0]) + raised};
}

/// Finds the gaps above one region.
class GapFinder {
  public:
    GapFinder(const Scene& scene, const Field<RegionId, double>& raised, const std::vector<Box>& boxes,
              const Bvh& faces, double rounding)
        : scene_(scene), raised_(raised), boxes_(boxes), faces_(faces), rounding_(rounding) {}

    /// Calls add(face, whether it is stacked on the region, box of the points of the region's plane below the face).
    template <class Add>
    void operator()(RegionId own, double reach, const Add& add) {
        const Region& region = scene_.regions()[own];
        for (SurfaceId s : region.surfaces) find_above(s, own, reach, add);
    }

  private:
    struct Found {
        SurfaceId above;
        bool is_stacked;
        Box box;
    };

    template <class Add>
    void find_above(SurfaceId s, RegionId own, double reach, const Add& add) {
        const Plane plane = plane_of(scene_, s, raised_[own]);
        Box below = boxes_[s.value];
        below.lo = below.lo - Vec3{reach, reach, reach}, below.hi = below.hi + Vec3{reach, reach, reach};
        find_borders(scene_.outline(s), plane.n, reach);
        region_.clear();
        region_.add({plane.n, plane.offset + rounding_});
        region_.add({-1 * plane.n, -plane.offset - reach});
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 axis{};
            axis[k] = 1;
            region_.add({axis, below.lo[k]}), region_.add({-1 * axis, -below.hi[k]});
        }
        for (const Plane& border : borders_) region_.add(border);
        found_.clear();
        double area = 0;  // of the points below close faces, m^2
        faces_.visit_region(region_, [&](std::uint32_t other) {
            const SurfaceId b(other);
            if (scene_.surfaces()[b].region == own) return;
            if (std::abs(dot(scene_.surfaces()[b].normal, plane.n)) < perpendicular) return;
            Found found{b, false, {}};
            Box& box = found.box;
            if (!crosses(s, plane, found, reach) || !meet(box, below)) return;
            for (std::size_t k = 0; k < 3; ++k)
                box.lo[k] = std::max(box.lo[k], below.lo[k]), box.hi[k] = std::min(box.hi[k], below.hi[k]);
            found_.push_back(found);
            area += std::abs(dot(area_vector(slice_), plane.n));
        });
        if (area < negligible_share * scene_.surfaces()[s].area) return;
        for (const Found& found : found_) add(found.above, found.is_stacked, found.box);
    }

    /// Sets borders_: planes perpendicular to an outline, parallel to its edges and at most `margin` outside of it. A
    /// convex outline of few corners is all that is within them. The box of a face that is not parallel to the axes is
    /// much larger than the face.
    void find_borders(std::span<const Point> outline, const Normal& n, double margin) {
        borders_.clear();
        const std::size_t step = (outline.size() + max_borders - 1) / max_borders;
        for (std::size_t i = 0; i < outline.size(); i += step) {
            const Vec3 inwards = cross(n, outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i]);
            const double length = norm(inwards);
            if (!(length > 0)) continue;
            Plane border{(1 / length) * inwards, std::numeric_limits<double>::infinity()};
            for (const Point& p : outline) border.offset = std::min(border.offset, dot(border.n, p));
            border.offset -= margin;
            borders_.push_back(border);
        }
    }

    /// True if the face `found.above` is partly between the heights of `rounding` and `reach` above the plane and above
    /// the points within the borders, and is not stacked on the plane unless it faces the same way. Sets `slice_` to
    /// that part, and the rest of `found`: the box contains the part and the points below it.
    bool crosses(SurfaceId s, const Plane& plane, Found& found, double reach) {
        const Surface& other = scene_.surfaces()[found.above];
        const std::span<const Point> outline = scene_.outline(found.above);
        const double raised = raised_[other.region] * dot(other.normal, plane.n);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Point& p : outline) {
            const double h = plane.signed_distance(p) + raised;
            low = std::min(low, h), high = std::max(high, h);
        }
        if (high <= rounding_ || low >= reach) return false;
        found.is_stacked = are_stacked(s, found.above);
        if (found.is_stacked) {
            if (dot(other.normal, plane.n) < 0 || low <= rounding_) return false;
            slice_.assign(outline.begin(), outline.end());
        } else {
            clip(outline, {plane.n, plane.offset}, above_);
            clip(above_, {-1 * plane.n, -plane.offset - reach}, slice_);
        }
        for (const Plane& border : borders_) {
            if (slice_.empty()) return false;
            std::swap(above_, slice_);
            clip(above_, border, slice_);
        }
        if (slice_.empty()) return false;
        const double own_raised = raised_[scene_.surfaces()[s].region];
        for (const Point& p : slice_)
            found.box.add(p), found.box.add(p - (plane.signed_distance(p) + own_raised) * plane.n);
        return true;
    }

    /// True if the space between two faces counts as nothing.
    bool are_stacked(SurfaceId a, SurfaceId b) const {
        const double thickness = std::max(
            rounding_, std::min(coplanar_share * scene_.size(), coplanar_share_of_face * boxes_[b.value].diagonal()));
        return is_within(scene_.outline(b), plane_of(scene_, a, 0), thickness) ||
               is_within(scene_.outline(a), plane_of(scene_, b, 0), thickness);
    }

    const Scene& scene_;
    const Field<RegionId, double>& raised_;
    const std::vector<Box>& boxes_;
    const Bvh& faces_;
    double rounding_;
    static constexpr std::size_t max_borders = 8;  ///< With the slab and the box, all fit into a ConvexRegion.
    ConvexRegion region_;
    std::vector<Plane> borders_;
    std::vector<Point> above_, slice_;
    std::vector<Found> found_;
};

}  // namespace

bool is_within(std::span<const Point> outline, const Plane& plane, double distance) {
    return std::all_of(outline.begin(), outline.end(),
                       [&](const Point& p) { return std::abs(plane.signed_distance(p)) <= distance; });
}

NarrowGaps::NarrowGaps(const Scene& scene, const Field<RegionId, double>& reach, const Field<RegionId, double>& raised)
    : scene_(&scene), reach_(reach), raised_(raised) {
    const Box& all = scene.box();
    const Vec3 farthest = max(all.hi, -1 * all.lo);
    rounding_ = roundings * std::numeric_limits<double>::epsilon() * std::max({farthest.x, farthest.y, farthest.z});
    std::vector<Box> boxes;
    boxes.reserve(scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids())
        boxes.push_back(outline_box(scene, s, raised[scene.surfaces()[s].region]));
    const Bvh faces(boxes);
    struct Found {
        Gap gap;
        Box box;
    };
    constexpr std::size_t regions_a_range = 256;
    const std::size_t regions = scene.regions().size();
    std::vector<std::vector<Found>> found((regions + regions_a_range - 1) / regions_a_range);
    parallel_for(found.size(), 1, [&](std::size_t range) {
        GapFinder find(scene, raised, boxes, faces, rounding_);
        for (std::size_t r = range * regions_a_range; r < std::min(regions, (range + 1) * regions_a_range); ++r) {
            const RegionId own(static_cast<std::uint32_t>(r));
            find(own, reach_[own], [&](SurfaceId above, bool is_stacked, Box box) {
                const Vec3 margin{rounding_, rounding_, rounding_};
                box.lo = box.lo - margin, box.hi = box.hi + margin;
                found[range].push_back({{own, above, is_stacked}, box});
            });
        }
    });
    std::vector<Box> below;
    for (const std::vector<Found>& some : found)
        for (const Found& one : some) gaps_.push_back(one.gap), below.push_back(one.box);
    if (gaps_.empty()) return;
    has_gap_.resize(regions);
    for (const Gap& gap : gaps_) has_gap_[gap.own] = 1;
    tree_ = Bvh(below);
}

template <class Visit>
void NarrowGaps::visit(const Point& x, RegionId own, bool are_stacked, const Visit& visit) const {
    Box at;
    at.add(x);
    tree_.visit_box(at, [&](std::uint32_t item) {
        const Gap& gap = gaps_[item];
        if (gap.own == own && gap.is_stacked == are_stacked) visit(gap.above);
    });
}

SurfaceId NarrowGaps::cover(const Point& x, RegionId own) const {
    SurfaceId found;
    visit(x, own, true, [&](SurfaceId above) {
        if (contains(scene_->outline(above), scene_->surfaces()[above].normal, x)) found = std::min(found, above);
    });
    return found;
}

double NarrowGaps::height(const Point& x, RegionId own) const {
    double lowest = std::numeric_limits<double>::infinity();
    const Normal& n = scene_->regions()[own].plane.n;
    const Point start = x + raised_[own] * n;
    visit(x, own, false, [&](SurfaceId above) {
        const Plane plane = raised_plane(above);
        const double h = -plane.signed_distance(start) / dot(plane.n, n);
        if (h <= rounding_ || h > std::min(lowest, reach_[own])) return;
        if (contains(scene_->outline(above), plane.n, start + h * n)) lowest = h;
    });
    return lowest;
}

NarrowGaps::Met NarrowGaps::first(const Point& x, const Vec3& direction, RegionId own) const {
    Met met{SurfaceId(), std::numeric_limits<double>::infinity(), false};
    const Point start = x + raised_[own] * scene_->regions()[own].plane.n;
    visit(x, own, false, [&](SurfaceId above) {
        const Plane plane = raised_plane(above);
        const double slope = dot(plane.n, direction), t = -plane.signed_distance(start) / slope;
        const bool front = slope < 0;
        if (!(t > 0) || t > met.distance || (t == met.distance && !front)) return;
        if (contains(scene_->outline(above), plane.n, start + t * direction)) met = {above, t, front};
    });
    return met;
}

bool NarrowGaps::decides(const Point& x, RegionId own, SurfaceId surface) const {
    bool any = false;
    visit(x, own, false, [&](SurfaceId above) { any |= above == surface; });
    return any;
}

Plane NarrowGaps::raised_plane(SurfaceId s) const {
    return plane_of(*scene_, s, raised_[scene_->surfaces()[s].region]);
}

}  // namespace exitance

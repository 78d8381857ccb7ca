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

Box outline_box(std::span<const Point> outline) {
    Box box;
    for (const Point& p : outline) box.add(p);
    return box;
}

bool meet(const Box& a, const Box& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
    return true;
}

Plane plane_of(const Scene& scene, SurfaceId s) {
    const Normal& n = scene.surfaces()[s].normal;
    return {n, dot(n, scene.outline(s)[0])};
}

/// Finds the gaps above one region.
class GapFinder {
  public:
    GapFinder(const Scene& scene, const std::vector<Box>& boxes, const Bvh& faces, double rounding)
        : scene_(scene), boxes_(boxes), faces_(faces), rounding_(rounding) {}

    /// Calls add(face, box of the points of the region's plane below the face).
    template <class Add>
    void operator()(RegionId own, double reach, const Add& add) {
        const Region& region = scene_.regions()[own];
        for (SurfaceId s : region.surfaces) find_above(s, own, reach, add);
    }

  private:
    template <class Add>
    void find_above(SurfaceId s, RegionId own, double reach, const Add& add) {
        const Plane plane = plane_of(scene_, s);
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
            Box box;
            if (!crosses(s, plane, b, reach, box) || !meet(box, below)) return;
            for (std::size_t k = 0; k < 3; ++k)
                box.lo[k] = std::max(box.lo[k], below.lo[k]), box.hi[k] = std::min(box.hi[k], below.hi[k]);
            found_.push_back({b, box});
            area += std::abs(dot(area_vector(slice_), plane.n));
        });
        if (area < negligible_share * scene_.surfaces()[s].area) return;
        for (const auto& [b, box] : found_) add(b, box);
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

    /// True if the face is partly between the heights of `rounding` and `reach` above the plane and above the points
    /// within the borders, and is not stacked on the plane. Sets `slice_` to that part, and `box` to a box of it and of
    /// the points below it.
    bool crosses(SurfaceId s, const Plane& plane, SurfaceId b, double reach, Box& box) {
        const std::span<const Point> outline = scene_.outline(b);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Point& p : outline) {
            const double h = plane.signed_distance(p);
            low = std::min(low, h), high = std::max(high, h);
        }
        if (high <= rounding_ || low >= reach) return false;
        const double thickness = std::max(
            rounding_, std::min(coplanar_share * scene_.size(), coplanar_share_of_face * boxes_[b.value].diagonal()));
        if (is_within(outline, plane, thickness) || is_within(scene_.outline(s), plane_of(scene_, b), thickness))
            return false;
        clip(outline, {plane.n, plane.offset}, above_);
        clip(above_, {-1 * plane.n, -plane.offset - reach}, slice_);
        for (const Plane& border : borders_) {
            if (slice_.empty()) return false;
            std::swap(above_, slice_);
            clip(above_, border, slice_);
        }
        if (slice_.empty()) return false;
        for (const Point& p : slice_) box.add(p), box.add(p - plane.signed_distance(p) * plane.n);
        return true;
    }

    const Scene& scene_;
    const std::vector<Box>& boxes_;
    const Bvh& faces_;
    double rounding_;
    static constexpr std::size_t max_borders = 8;  ///< With the slab and the box, all fit into a ConvexRegion.
    ConvexRegion region_;
    std::vector<Plane> borders_;
    std::vector<Point> above_, slice_;
    std::vector<std::pair<SurfaceId, Box>> found_;
};

}  // namespace

bool is_within(std::span<const Point> outline, const Plane& plane, double distance) {
    return std::all_of(outline.begin(), outline.end(),
                       [&](const Point& p) { return std::abs(plane.signed_distance(p)) <= distance; });
}

NarrowGaps::NarrowGaps(const Scene& scene, const Field<RegionId, double>& reach) : scene_(&scene), reach_(reach) {
    const Box& all = scene.box();
    const Vec3 farthest = max(all.hi, -1 * all.lo);
    rounding_ = roundings * std::numeric_limits<double>::epsilon() * std::max({farthest.x, farthest.y, farthest.z});
    std::vector<Box> boxes;
    boxes.reserve(scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids()) boxes.push_back(outline_box(scene.outline(s)));
    const Bvh faces(boxes);
    struct Found {
        Gap gap;
        Box box;
    };
    constexpr std::size_t regions_a_range = 256;
    const std::size_t regions = scene.regions().size();
    std::vector<std::vector<Found>> found((regions + regions_a_range - 1) / regions_a_range);
    parallel_for(found.size(), 1, [&](std::size_t range) {
        GapFinder find(scene, boxes, faces, rounding_);
        for (std::size_t r = range * regions_a_range; r < std::min(regions, (range + 1) * regions_a_range); ++r) {
            const RegionId own(static_cast<std::uint32_t>(r));
            find(own, reach_[own], [&](SurfaceId above, Box box) {
                const Vec3 margin{rounding_, rounding_, rounding_};
                box.lo = box.lo - margin, box.hi = box.hi + margin;
                found[range].push_back({{own, above}, box});
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
void NarrowGaps::visit(const Point& x, RegionId own, const Visit& visit) const {
    Box at;
    at.add(x);
    tree_.visit_box(at, [&](std::uint32_t item) {
        if (gaps_[item].own == own) visit(gaps_[item].above);
    });
}

double NarrowGaps::height(const Point& x, RegionId own) const {
    double lowest = std::numeric_limits<double>::infinity();
    const Normal& n = scene_->regions()[own].plane.n;
    visit(x, own, [&](SurfaceId above) {
        const Plane plane = plane_of(*scene_, above);
        const double h = -plane.signed_distance(x) / dot(plane.n, n);
        if (h <= rounding_ || h > std::min(lowest, reach_[own])) return;
        if (contains(scene_->outline(above), plane.n, x + h * n)) lowest = h;
    });
    return lowest;
}

NarrowGaps::Met NarrowGaps::first(const Point& x, const Vec3& direction, RegionId own) const {
    Met met{SurfaceId(), std::numeric_limits<double>::infinity(), false};
    visit(x, own, [&](SurfaceId above) {
        const Plane plane = plane_of(*scene_, above);
        const double slope = dot(plane.n, direction), t = -plane.signed_distance(x) / slope;
        const bool front = slope < 0;
        if (!(t > 0) || t > met.distance || (t == met.distance && !front)) return;
        if (contains(scene_->outline(above), plane.n, x + t * direction)) met = {above, t, front};
    });
    return met;
}

bool NarrowGaps::decides(const Point& x, RegionId own, SurfaceId surface) const {
    bool any = false;
    visit(x, own, [&](SurfaceId above) { any |= above == surface; });
    return any;
}

}  // namespace exitance

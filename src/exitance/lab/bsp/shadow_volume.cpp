#include "exitance/lab/bsp/shadow_volume.hpp"

#include <algorithm>

#include "exitance/lab/bsp/plane_sides.hpp"

namespace exitance {

ShadowVolume::ShadowVolume(std::span<const Point> source, const Plane& source_plane, std::span<const Point> occluder,
                           const Plane& occluder_plane, double thickness)
    : thickness_(thickness), source_(source.begin(), source.end()) {
    clip(occluder, source_plane, occluder_);
    if (occluder_.size() < 3 || sides(occluder_, source_plane, thickness) == 0) return;
    const int seen = sides(source_, occluder_plane, thickness);
    if (seen == 0) return;  // edge-on
    add_planes(occluder_, source_, true);
    add_planes(source_, occluder_, false);
    if (seen == 3) {
        umbra_.clear();
        return;
    }
    const Plane behind = seen == 1 ? turned(occluder_plane) : occluder_plane;
    penumbra_.push_back(behind);
    // A corner of the source in the occluder's plane sees it edge-on: from there nothing is hidden, so there is no
    // umbra.
    const bool touches = std::any_of(source_.begin(), source_.end(), [&](const Point& s) {
        return std::abs(occluder_plane.signed_distance(s)) <= thickness;
    });
    touches ? umbra_.clear() : umbra_.push_back(behind);
}

/// Adds a plane unless it is known: aligned edges span the same plane several times.
void ShadowVolume::add_once(const Plane& plane, std::vector<Plane>& planes) const {
    constexpr double same_direction = 1e-9;
    if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) {
            return norm(p.n - plane.n) < same_direction && std::abs(p.offset - plane.offset) <= thickness_;
        }))
        planes.push_back(plane);
}

/// Adds the planes through an edge of one polygon and a corner of the other that have each polygon on one side.
void ShadowVolume::add_planes(std::span<const Point> edges, std::span<const Point> corners, bool of_occluder) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Point &a = edges[i], &b = edges[(i + 1) % edges.size()];
        for (const Point& c : corners) {
            const Vec3 n = cross(b - a, c - a);
            const double length = norm(n);
            if (!(length > thickness_ * norm(b - a))) continue;
            Plane plane{n / length, dot(n, a) / length};
            int occluder = sides(occluder_, plane, thickness_);
            int source = sides(source_, plane, thickness_);
            if (occluder == 3 || source == 3 || occluder == 0) continue;
            if (occluder == 2) plane = turned(plane), occluder = 1, source = source == 0 ? 0 : 3 - source;
            if (source != 1)
                add_once(plane, penumbra_);
            else if (of_occluder)
                add_once(plane, umbra_);
        }
    }
}

ShadowVolume::Place ShadowVolume::place(std::span<const Plane> planes, std::span<const Point> receiver,
                                        std::size_t& tests) const {
    if (planes.empty()) return Place::outside;
    Place out = Place::inside;
    for (const Plane& plane : planes) {
        ++tests;
        const int side = sides(receiver, plane, thickness_);
        if ((side & 1) == 0) return Place::outside;
        if (side == 3) out = Place::partly;
    }
    return out;
}

ShadowVolume::Place ShadowVolume::in_penumbra(std::span<const Point> receiver, std::size_t& tests) const {
    return place(penumbra_, receiver, tests);
}

ShadowVolume::Place ShadowVolume::in_umbra(std::span<const Point> receiver, std::size_t& tests) const {
    return place(umbra_, receiver, tests);
}

}  // namespace exitance

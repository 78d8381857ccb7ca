#include "exitance/visibility/thin_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/clip_convex.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/scene/opposed_faces.hpp"

namespace exitance {
namespace {

/// The largest common part of convex pieces of two regions.
struct Contact {
    std::pair<RegionId, RegionId> regions;
    double area = 0;              ///< m^2
    std::array<Point, 3> places;  ///< Points in it.
    bool operator<(const Contact& other) const {
        return std::pair(regions, -area) < std::pair(other.regions, -other.area);
    }
};

std::vector<PieceId> pieces_of_opposed_faces(const Occluders& occluders, const RayTracer& tracer) {
    Field<RegionId, char> is_listed;
    std::vector<PieceId> out;
    for (const SurfaceId s : tracer.opposed_faces()) {
        is_listed.resize(occluders.scene().regions().size());
        const RegionId region = occluders.scene().surfaces()[s].region;
        if (std::exchange(is_listed[region], 1)) continue;
        for (const PieceId p : occluders.pieces(region)) out.push_back(p);
    }
    return out;
}

/// Part of a convex outline that is inside another one in its plane.
std::vector<Point> common_part(std::span<const Point> a, std::span<const Point> b, const Normal& normal_of_b) {
    std::vector<Point> part(a.begin(), a.end()), clipped;
    for (std::size_t i = 0; i < b.size() && part.size() >= 3; ++i) {
        const Vec3 inwards = cross(normal_of_b, b[(i + 1) % b.size()] - b[i]);
        clip_convex(
            std::span<const Point>(part), [&](const Point& p) { return dot(inwards, p - b[i]); }, clipped);
        part.swap(clipped);
    }
    return part;
}

std::vector<Contact> find_contacts(const Occluders& occluders, std::span<const PieceId> pieces) {
    const double reach = coplanar_share * occluders.scene().size() + occluders.rounding();
    const Vec3 margin{reach, reach, reach};
    std::vector<Box> boxes(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (const Point& p : occluders.corners(pieces[i])) boxes[i].add(p);
        boxes[i].lo -= margin, boxes[i].hi += margin;
    }
    std::vector<Contact> out;
    const Bvh tree(boxes);
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
        tree.visit_box(boxes[i], [&](std::uint32_t j) {
            const ConvexPiece &a = occluders.pieces()[pieces[i]], &b = occluders.pieces()[pieces[j]];
            if (j >= i || dot(a.plane.n, b.plane.n) > -parallel_cosine) return false;
            const std::span<const Point> outline = occluders.corners(pieces[i]), other = occluders.corners(pieces[j]);
            const double thickness = std::min(a.thickness, b.thickness);
            const auto is_near = [&](const Point& p) { return std::abs(b.plane.signed_distance(p)) <= thickness; };
            if (!std::all_of(outline.begin(), outline.end(), is_near)) return false;
            const std::vector<Point> part = common_part(outline, other, b.plane.n);
            if (part.size() < 3) return false;
            const double area = norm(area_vector(part));
            if (!(area > 0)) return false;
            const Point middle = centroid(part);
            const auto towards = [&](std::size_t corner) { return middle + 0.5 * (part[corner] - middle); };
            out.push_back({std::minmax(a.region, b.region), area, {middle, towards(0), towards(part.size() / 2)}});
            return false;
        });
    std::sort(out.begin(), out.end());
    const auto are_alike = [](const Contact& a, const Contact& b) { return a.regions == b.regions; };
    out.erase(std::unique(out.begin(), out.end(), are_alike), out.end());
    return out;
}

/// True if most rays from a place meet fronts or leave the scene.
bool is_open(const Point& x, const Normal& n, RegionId region, const RayTracer& tracer) {
    constexpr int around = 8;
    // Rays along the normal and at 45 degrees to it. Derived from walls, which are rarely parallel to rays turned by
    // this share of the angle between them.
    constexpr double turn = 0.3;
    const Frame frame(n);
    std::array<Vec3, 1 + around> directions{n};
    for (int k = 0; k < around; ++k) {
        const double angle = 2 * pi * (k + turn) / around;
        directions[static_cast<std::size_t>(k) + 1] = frame.to_world(std::cos(angle), std::sin(angle), 1);
    }
    std::array<RayHit, directions.size()> hits;
    tracer.nearest(directions, x, region, hits);
    const auto sees_light = [](const RayHit& hit) { return hit.surface.is_none() || hit.front || hit.is_glass; };
    return 2 * std::count_if(hits.begin(), hits.end(), sees_light) > static_cast<std::ptrdiff_t>(hits.size());
}

}  // namespace

std::vector<std::pair<RegionId, RegionId>> find_thin_walls(const Occluders& occluders, const RayTracer& tracer) {
    const std::vector<Contact> contacts = find_contacts(occluders, pieces_of_opposed_faces(occluders, tracer));
    const auto has_open_side = [&](const Contact& contact, RegionId side) {
        const Normal& n = occluders.scene().regions()[side].plane.n;
        return std::any_of(contact.places.begin(), contact.places.end(),
                           [&](const Point& x) { return is_open(x, n, side, tracer); });
    };
    std::vector<char> is_wall(contacts.size());
    parallel_for(contacts.size(), 16, [&](std::size_t i) {
        const auto& [one, other] = contacts[i].regions;
        is_wall[i] = has_open_side(contacts[i], one) && has_open_side(contacts[i], other);
    });
    std::vector<std::pair<RegionId, RegionId>> out;
    for (std::size_t i = 0; i < contacts.size(); ++i)
        if (is_wall[i]) out.push_back(contacts[i].regions);
    return out;
}

}  // namespace exitance

#include "exitance/scene/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exitance/scene/hull.hpp"

namespace exitance {
namespace {

constexpr double position_tolerance = 1e-6;  ///< Relative to the scene's size: nearer points are equal.

std::vector<Triangle> triangles_of(const Scene& scene, RegionId r) {
    std::vector<Triangle> out;
    for (const SurfaceId s : scene.regions()[r].surfaces)
        for (const Triangle& t : triangles_of(scene.outline(s), scene.surfaces()[s].normal)) out.push_back(t);
    return out;
}

/// Returns the planes of panes that have an edge in a region's plane but are not parallel to it: there the reveal
/// continues beyond the pane. Each plane once.
std::vector<Plane> planes_across(const Region& region, const std::vector<Pane>& panes, const Bvh& index,
                                 double tolerance) {
    Box box;
    for (const auto& loop : region.loops) box.add(box_of(loop));
    box = grown(box, tolerance);
    std::vector<std::uint32_t> near;
    index.visit_box(box, [&](std::uint32_t i) { near.push_back(i); });
    std::sort(near.begin(), near.end());
    std::vector<Plane> out;
    for (const std::uint32_t i_pane : near) {
        const Pane& pane = panes[i_pane];
        constexpr double parallel = 1e-6;  // sine
        if (norm(cross(pane.n, region.plane.n)) < parallel) continue;
        const std::size_t m = pane.corners.size();
        const auto is_in_plane = [&](const Point& p) { return std::abs(region.plane.signed_distance(p)) <= tolerance; };
        for (std::size_t i = 0; i < m; ++i) {
            const std::array<Point, 2> edge{pane.corners[i], pane.corners[(i + 1) % m]};
            if (!is_in_plane(edge[0]) || !is_in_plane(edge[1])) continue;
            const Box of_edge = box_of(edge);
            bool apart = false;
            for (std::size_t k = 0; k < 3; ++k) apart = apart || of_edge.lo[k] > box.hi[k] || of_edge.hi[k] < box.lo[k];
            const Plane plane{pane.n, dot(pane.n, pane.corners[0])};
            const auto is_same = [&](const Plane& other) {
                return norm(cross(other.n, plane.n)) < parallel &&
                       std::abs(other.signed_distance(pane.corners[0])) <= tolerance;
            };
            if (!apart && std::none_of(out.begin(), out.end(), is_same)) out.push_back(plane);
        }
    }
    return out;
}

/// Returns the faces of a region, split where panes cross it.
std::vector<BorderedFace> faces_of(const Scene& scene, RegionId r, const Bvh& panes, double tolerance) {
    using Parts = std::vector<std::vector<Point>>;  // convex
    const Region& region = scene.regions()[r];
    const std::vector<Triangle> triangles = triangles_of(scene, r);
    Parts all;
    for (const Triangle& t : triangles) all.emplace_back(t.begin(), t.end());
    std::vector<Parts> cut{std::move(all)};
    for (const Plane& plane : planes_across(region, scene.panes(), panes, tolerance)) {
        std::vector<Parts> finer;
        for (const Parts& whole : cut)
            for (const double side : {1.0, -1.0}) {
                Parts half;
                std::vector<Point> out;
                for (const std::vector<Point>& part : whole) {
                    const auto is_off = [&](const Point& p) { return side * plane.signed_distance(p) > tolerance; };
                    if (std::none_of(part.begin(), part.end(), is_off)) continue;
                    clip(part, {side * plane.n, side * plane.offset}, out);
                    if (out.size() >= 3) half.push_back(out);
                }
                if (!half.empty()) finer.push_back(std::move(half));
            }
        cut = std::move(finer);
    }
    std::vector<BorderedFace> out;
    if (cut.size() == 1) {
        for (const SurfaceId s : region.surfaces) {
            const auto outline = scene.outline(s);
            out.push_back({.loops = {{outline.begin(), outline.end()}},
                           .triangles = triangles_of(outline, scene.surfaces()[s].normal),
                           .n = region.plane.n});
        }
        return out;
    }
    for (const Parts& parts : cut) {
        BorderedFace& face = out.emplace_back(BorderedFace{.loops = parts, .triangles = {}, .n = region.plane.n});
        for (const std::vector<Point>& part : parts)
            for (std::size_t k = 2; k < part.size(); ++k) face.triangles.push_back({part[0], part[k - 1], part[k]});
    }
    return out;
}

/// Returns the volume behind the sides, m^3; negative if their fronts are inside.
double volume_behind(const Borders& borders, const std::vector<FaceSide>& sides, const Point& origin) {
    double sum = 0;
    for (const FaceSide& side : sides)
        for (const Triangle& t : borders.face(side.face).triangles)
            sum += (side.is_front ? 1 : -1) * dot(t[0] - origin, cross(t[1] - origin, t[2] - origin)) / 6;
    return sum;
}

/// Which sides of a face bound a room behind panes: 1 front, 2 back, 3 both. A pane that bounds rooms on one side is a
/// window, unless a larger room surrounds it.
using RoomSides = std::vector<std::uint8_t>;
constexpr std::uint8_t in_front = 1, behind = 2;

/// Finds the rooms behind panes. Returns false if a pane bounds no room although a side of it cannot be told. Panes are
/// the faces from `first` on.
bool find_rooms(const Borders& borders, std::size_t first, RoomSides& rooms) {
    for (std::size_t f = first; f < rooms.size(); ++f) {
        const Point origin = borders.face(f).loops[0][0];
        bool is_certain = true;
        for (const bool is_front : {true, false}) {
            if (rooms[f] & (is_front ? in_front : behind)) continue;
            const auto sides = borders.sides_reached_from({static_cast<std::uint32_t>(f), is_front});
            is_certain = is_certain && !sides.empty();
            if (sides.empty() || !(volume_behind(borders, sides, origin) < 0)) continue;
            for (const FaceSide& side : sides) rooms[side.face] |= side.is_front ? in_front : behind;
        }
        if (rooms[f] == 0 && !is_certain) return false;
    }
    return true;
}

/// True if the hull winds about the outer side of a window: the room behind it stands in another one.
bool is_surrounded(const Pane& window, const Hull& hull, double slack) {
    const Point middle = centroid(window.corners);
    const auto is_in_room = [&](const Point& p) { return hull.winds_about(0.5 * (p + middle) - slack * window.n); };
    return std::any_of(window.corners.begin(), window.corners.end(), is_in_room);
}

/// True if a straight path that leaves by one window may enter by the other: each has a part behind the other.
bool face_each_other(const Pane& a, const Pane& b, double slack) {
    const auto reaches_beyond = [&](const Pane& one, const Pane& other) {
        return std::any_of(one.corners.begin(), one.corners.end(),
                           [&](const Point& p) { return dot(other.n, p - other.corners[0]) < -slack; });
    };
    return reaches_beyond(a, b) && reaches_beyond(b, a);
}

/// True if two windows face each other; also if there are too many candidate windows to test.
bool any_face_each_other(const std::vector<Pane>& windows, double slack) {
    constexpr std::size_t too_many = 5000;
    Box box;
    for (const Pane& window : windows) box.add(box_of(window.corners));
    std::vector<const Pane*> inner;  // panes inside the box, since most facades are on the box itself
    for (const Pane& window : windows) {
        const Point farthest{window.n.x > 0 ? box.lo.x : box.hi.x, window.n.y > 0 ? box.lo.y : box.hi.y,
                             window.n.z > 0 ? box.lo.z : box.hi.z};
        if (dot(window.n, farthest - window.corners[0]) < -slack) inner.push_back(&window);
    }
    if (inner.size() > too_many) return true;
    for (std::size_t i = 0; i < inner.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (face_each_other(*inner[i], *inner[k], slack)) return true;
    return false;
}

/// True if the hull winds about the whole front side of a region.
bool winds_about(const Scene& scene, RegionId r, const Hull& hull, double slack) {
    // position of the tested points, relative to the distance between a corner and the centre
    constexpr double inset = 1e-3;
    const Normal& n = scene.regions()[r].plane.n;
    for (const Triangle& t : triangles_of(scene, r)) {
        if (hull.crosses(t, slack)) return false;
        const Point middle = (t[0] + t[1] + t[2]) / 3;
        for (const Point& p : {middle, t[0], t[1], t[2]})
            if (!hull.winds_about(p + inset * (middle - p) + slack * n)) return false;
    }
    return true;
}

}  // namespace

Enclosure find_enclosure(const Scene& scene) {
    if (scene.panes().empty() || scene.distant().domes.empty()) return {};
    const double tolerance = position_tolerance * scene.size();
    std::vector<Box> boxes;
    for (const Pane& pane : scene.panes()) boxes.push_back(box_of(pane.corners));
    const Bvh index(boxes);
    std::vector<BorderedFace> faces;
    for (const RegionId r : scene.regions().ids())
        for (BorderedFace& face : faces_of(scene, r, index, tolerance)) faces.push_back(std::move(face));
    const std::size_t first = faces.size();
    for (const Pane& pane : scene.panes())
        faces.push_back({.loops = {pane.corners}, .triangles = triangles_of(pane.corners, pane.n), .n = pane.n});
    RoomSides rooms(faces.size(), 0);
    const Borders borders(std::move(faces), tolerance);
    if (!find_rooms(borders, first, rooms)) return {};
    Hull hull;
    for (std::size_t f = 0; f < rooms.size(); ++f)
        for (const Triangle& t : borders.face(f).triangles) {
            if (rooms[f] == in_front) hull.add(t);
            if (rooms[f] == behind) hull.add({t[0], t[2], t[1]});
        }
    hull.finish();
    Enclosure out;
    for (std::size_t i = 0; i < scene.panes().size(); ++i) {
        Pane pane = scene.panes()[i];
        const std::uint8_t sides = rooms[first + i];
        if (sides == behind) std::reverse(pane.corners.begin(), pane.corners.end());
        pane.n = normalized(area_vector(pane.corners));
        const bool is_window = (sides == in_front || sides == behind) && !is_surrounded(pane, hull, 2 * tolerance);
        (is_window ? out.windows : out.others).push_back(std::move(pane));
    }
    if (out.windows.empty() || any_face_each_other(out.windows, tolerance)) return {};
    out.is_within.resize(scene.regions().size());
    for (const RegionId r : scene.regions().ids()) out.is_within[r] = winds_about(scene, r, hull, 2 * tolerance);
    return out;
}

}  // namespace exitance

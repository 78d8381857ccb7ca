#include "exitance/scene/overlaps.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/scene/cell_keys.hpp"
#include "exitance/scene/common_area.hpp"

namespace exitance {
namespace {

struct PlaneEntry {
    std::uint64_t key;
    std::uint32_t region;
    auto operator<=>(const PlaneEntry&) const = default;
};

/// Does the smaller region lie in the larger one's plane, facing the same way?
bool share_plane(const Region* a, const Region* b, double tolerance) {
    if (dot(a->plane.n, b->plane.n) <= 0) return false;
    if (a->area < b->area) std::swap(a, b);
    return std::all_of(b->loops.begin(), b->loops.end(), [&](const std::vector<Point>& loop) {
        return std::all_of(loop.begin(), loop.end(),
                           [&](const Point& p) { return std::abs(a->plane.signed_distance(p)) <= tolerance; });
    });
}

/// The pair of faces of two regions that overlaps most, if any does.
void compare(const Scene& scene, RegionId a, RegionId b, const Frame& frame, double tolerance,
             std::vector<Overlap>& out) {
    const auto box = [&](SurfaceId s) {
        FlatBox flat;
        for (const Point& p : scene.outline(s)) flat.add({dot(p, frame.u), dot(p, frame.v)});
        return flat;
    };
    Overlap most{{}, {}, 0};
    std::vector<std::pair<SurfaceId, FlatBox>> boxes;
    for (SurfaceId s : scene.regions()[b].surfaces) boxes.push_back({s, box(s)});
    for (SurfaceId s : scene.regions()[a].surfaces) {
        const FlatBox own = box(s);
        for (const auto& [t, other] : boxes) {
            if (!own.overlaps(other, tolerance)) continue;
            const double area = common_area(scene.outline(s), scene.outline(t), frame.n, tolerance);
            if (area > most.area) most = {std::min(s, t), std::max(s, t), area};
        }
    }
    if (most.area > 0) out.push_back(most);
}

/// Compares the regions of one cell of planes where their boxes overlap.
void compare_all(const Scene& scene, std::span<const PlaneEntry> group, double tolerance, std::vector<Overlap>& out) {
    const Frame frame(scene.regions()[RegionId(group[0].region)].plane.n);
    std::vector<FlatBox> boxes(group.size());
    for (std::size_t i = 0; i < group.size(); ++i)
        for (const auto& loop : scene.regions()[RegionId(group[i].region)].loops)
            for (const Point& p : loop) boxes[i].add({dot(p, frame.u), dot(p, frame.v)});
    each_overlap(boxes, tolerance, [&](std::uint32_t i, std::uint32_t j) {
        const RegionId a(group[i].region), b(group[j].region);
        if (share_plane(&scene.regions()[a], &scene.regions()[b], tolerance))
            compare(scene, a, b, frame, tolerance, out);
    });
}

}  // namespace

std::vector<Overlap> find_overlaps(const Scene& scene, double tolerance) {
    std::vector<PlaneEntry> entries;
    const double size = scene.size(), tilt = 1e-6;
    for (RegionId id : scene.regions().ids()) {
        const Plane& plane = scene.regions()[id].plane;
        const double offset = plane.offset - dot(plane.n, scene.box().centre());
        const auto direction = [&](double x) { return CellCoordinate{x, 1e-3, tilt}; };
        each_cell_key<4>(0,
                         {direction(plane.n.x), direction(plane.n.y), direction(plane.n.z),
                          CellCoordinate{offset, 1e-4 * size, tolerance + tilt * size}},
                         [&](std::uint64_t key) {
                             entries.push_back({key, id.value});
                         });
    }
    std::sort(entries.begin(), entries.end());
    std::vector<Overlap> out;
    for (std::size_t i = 0, j; i < entries.size(); i = j) {
        for (j = i + 1; j < entries.size() && entries[j].key == entries[i].key;) ++j;
        if (j - i > 1) compare_all(scene, std::span(entries).subspan(i, j - i), tolerance, out);
    }
    const auto ids = [](const Overlap& o) { return std::pair(o.first, o.second); };
    std::sort(out.begin(), out.end(), [&](const Overlap& a, const Overlap& b) { return ids(a) < ids(b); });
    out.erase(std::unique(out.begin(), out.end(), [&](const Overlap& a, const Overlap& b) { return ids(a) == ids(b); }),
              out.end());
    return out;
}

}  // namespace exitance

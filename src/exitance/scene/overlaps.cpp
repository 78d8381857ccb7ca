#include "exitance/scene/overlaps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "exitance/scene/joining/cell_keys.hpp"
#include "exitance/scene/joining/common_area.hpp"

namespace exitance {
namespace {

struct PlaneEntry {
    std::uint64_t key;
    std::uint32_t region;
    auto operator<=>(const PlaneEntry&) const = default;
};

/// An overlap and the regions of its faces.
struct Found {
    std::array<RegionId, 2> regions;  ///< Regions of the first and the second face.
    Overlap overlap;
};

/// Compares the faces of regions in one hash cell of planes if their boxes overlap. Returns true if it gave up.
bool compare_all(const Scene& scene, std::span<const PlaneEntry> group, double tolerance, std::vector<Found>& out) {
    const Frame frame(scene.regions()[RegionId(group[0].region)].plane.n);
    std::vector<SurfaceId> faces;
    for (const PlaneEntry& entry : group) {
        const auto& own = scene.regions()[RegionId(entry.region)].surfaces;
        faces.insert(faces.end(), own.begin(), own.end());
    }
    const auto& surfaces = scene.surfaces();
    // Sorted by decreasing area: each face is compared with the larger ones.
    std::sort(faces.begin(), faces.end(), [&](SurfaceId a, SurfaceId b) {
        return surfaces[a].area != surfaces[b].area ? surfaces[a].area > surfaces[b].area : a < b;
    });
    std::vector<FlatBox> boxes(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (const Point& p : scene.outline(faces[i])) boxes[i].add({dot(p, frame.u), dot(p, frame.v)});
    constexpr std::size_t max_examples = 4;
    std::size_t told = 0;
    std::uint32_t last = 0;
    return each_overlap(boxes, tolerance, [&](std::uint32_t i, std::uint32_t j) {
        if (i != std::exchange(last, i)) told = 0;
        const SurfaceId s = std::min(faces[i], faces[j]), t = std::max(faces[i], faces[j]);
        const std::array regions{surfaces[s].region, surfaces[t].region};
        const Plane& plane = scene.regions()[surfaces[faces[j]].region].plane;
        const auto in_plane = [&](const Point& p) { return std::abs(plane.signed_distance(p)) <= tolerance; };
        if (regions[0] == regions[1] || dot(surfaces[s].normal, surfaces[t].normal) <= 0) return false;
        if (!std::ranges::all_of(scene.outline(faces[i]), in_plane)) return false;
        const double area = common_area(scene.outline(s), scene.outline(t), frame.n, tolerance);
        if (area > 0) out.push_back({regions, {s, t, area}});
        return area > 0 && ++told == max_examples;
    });
}

}  // namespace

Overlaps find_overlaps(const Scene& scene, double tolerance) {
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
    Overlaps out;
    std::vector<Found> found;
    for (std::size_t i = 0, j; i < entries.size(); i = j) {
        for (j = i + 1; j < entries.size() && entries[j].key == entries[i].key;) ++j;
        if (j - i > 1) out.gave_up |= compare_all(scene, std::span(entries).subspan(i, j - i), tolerance, found);
    }
    // The face with the smaller id may be of either region.
    for (Found& f : found) std::ranges::sort(f.regions);
    std::ranges::sort(found, [](const Found& a, const Found& b) {
        return std::tie(a.regions, b.overlap.area, a.overlap.first, a.overlap.second) <
               std::tie(b.regions, a.overlap.area, b.overlap.first, b.overlap.second);
    });
    const auto are_alike = [](const Found& a, const Found& b) { return a.regions == b.regions; };
    found.erase(std::unique(found.begin(), found.end(), are_alike), found.end());
    for (const Found& f : found) out.pairs.push_back(f.overlap);
    std::ranges::sort(out.pairs, {}, [](const Overlap& o) { return std::pair(o.first, o.second); });
    return out;
}

}  // namespace exitance

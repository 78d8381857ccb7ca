#include "exitance/scene/opposed_faces.hpp"

#include <algorithm>

#include "exitance/scene/joining/cell_keys.hpp"

namespace exitance {
namespace {

/// A face in a hash cell of planes, regardless of its orientation.
struct Entry {
    std::uint64_t key;
    std::uint32_t face;
    bool is_turned;  ///< True if the cell contains the plane as seen from its back.
    auto operator<=>(const Entry&) const = default;
};

/// Adds the cells of a face's plane and of the same plane seen from its back. Faces in one plane within the tolerance
/// share a cell; other faces may share it, too.
void add_entries(const Scene& scene, SurfaceId s, double tolerance, std::vector<Entry>& out) {
    constexpr double cell = 1e-3, largest_tilt = 1e-4;  // at most an eighth of a cell, as each_cell_key requires
    const std::span<const Point> outline = scene.outline(s);
    Box box;
    for (const Point& p : outline) box.add(p);
    const double tilt = std::min(largest_tilt, tolerance / std::max(norm(box.hi - box.lo), tolerance));
    const Normal& n = scene.surfaces()[s].normal;
    const double offset = dot(n, outline[0] - scene.box().centre()), size = scene.size();
    for (const double sign : {1.0, -1.0})
        each_cell_key<4>(0,
                         {CellCoordinate{sign * n.x, cell, tilt}, CellCoordinate{sign * n.y, cell, tilt},
                          CellCoordinate{sign * n.z, cell, tilt},
                          CellCoordinate{sign * offset, cell * size, tolerance + tilt * size}},
                         [&](std::uint64_t key) {
                             out.push_back({key, s.value, sign < 0});
                         });
}

}  // namespace

OpposedFaces::OpposedFaces(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, double tolerance)
    : scene_(&scene), tolerance_(tolerance) {
    std::vector<Entry> entries;
    entries.reserve(2 * scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids()) add_entries(scene, s, tolerance, entries);
    std::sort(entries.begin(), entries.end());
    const auto is_single = [&](const Entry& e) {
        return other_side.size() == 0 || other_side[SurfaceId(e.face)].is_none();
    };
    for (auto first = entries.begin(); first != entries.end();) {
        const auto last = std::find_if(first, entries.end(), [&](const Entry& e) { return e.key != first->key; });
        const bool look_both_ways = std::any_of(first, last, [](const Entry& e) { return e.is_turned; }) &&
                                    std::any_of(first, last, [](const Entry& e) { return !e.is_turned; });
        if (look_both_ways && std::any_of(first, last, is_single)) {
            is_opposed_.resize(scene.surfaces().size());
            for (auto e = first; e != last; ++e) is_opposed_[SurfaceId(e->face)] = 1;
        }
        first = last;
    }
    if (is_opposed_.size() == 0) return;
    std::vector<Box> boxes;
    const Vec3 margin{tolerance, tolerance, tolerance};
    for (SurfaceId s : scene.surfaces().ids()) {
        if (!is_opposed_[s]) continue;
        Box& box = boxes.emplace_back();
        for (const Point& p : scene.outline(s)) box.add(p);
        box.lo -= margin, box.hi += margin;
        faces_.push_back(s);
    }
    tree_ = Bvh(boxes);
}

SurfaceId OpposedFaces::facing(const Point& at, const Vec3& direction) const {
    SurfaceId best;
    const auto level = [&](SurfaceId s) { return scene_->regions()[scene_->surfaces()[s].region].level; };
    tree_.visit_box({at, at}, [&](std::uint32_t i) {
        const SurfaceId s = faces_[i];
        const Normal& n = scene_->surfaces()[s].normal;
        const std::span<const Point> outline = scene_->outline(s);
        if (!(dot(n, direction) < 0) || !(std::abs(dot(n, at - outline[0])) <= tolerance_)) return;
        if (!contains(outline, n, at)) return;
        if (best.is_none() || level(s) > level(best) || (level(s) == level(best) && s < best)) best = s;
    });
    return best;
}

}  // namespace exitance

// The two sides of diffusing panes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "exitance/scene/other_side.hpp"
#include "exitance/scene/scene_builder.hpp"

namespace exitance {

/// Adds the missing second side of diffusing panes that have only one face in the file.
void SceneBuilder::add_other_sides() {
    const auto passes = [&](const SceneDescription::Face& face) {
        return face.material < in_.materials.size() && in_.materials[face.material].is_diffusing_pane();
    };
    if (std::none_of(in_.faces.begin(), in_.faces.end(), passes)) return;
    // Corners of the two sides are often points of their own, at the same place.
    std::map<std::array<double, 3>, std::uint32_t> first_at;
    const auto from_smallest = [&](std::vector<std::uint32_t> corners) {
        for (std::uint32_t& c : corners) {
            if (c >= in_.points.size()) continue;  // reported later
            const Point& p = in_.points[c];
            c = first_at.try_emplace({p.x, p.y, p.z}, c).first->second;
        }
        if (!corners.empty())
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        return corners;
    };
    std::set<std::vector<std::uint32_t>> sides;
    for (const SceneDescription::Face& face : in_.faces)
        if (passes(face)) sides.insert(from_smallest(face.corners));
    for (std::size_t f = 0, count = in_.faces.size(); f < count; ++f) {
        if (!passes(in_.faces[f])) continue;
        SceneDescription::Face other = in_.faces[f];
        std::reverse(other.corners.begin(), other.corners.end());
        if (sides.insert(from_smallest(other.corners)).second) in_.faces.push_back(std::move(other));
    }
}

/// Links the regions of the two sides of diffusing panes.
void SceneBuilder::pair_sides(Scene& scene) {
    const auto passes = [&](RegionId r) { return scene.material(r).is_diffusing_pane(); };
    const auto ids = scene.regions_.ids();
    if (std::none_of(ids.begin(), ids.end(), passes)) return;
    const Field<RegionId, RegionId> other = other_sides_of_regions(scene);
    for (const RegionId r : ids) {
        if (!passes(r)) continue;
        Region& region = scene.regions_[r];
        if (other.size() > 0 && !other[r].is_none() && passes(other[r])) {
            region.behind = other[r];
            continue;
        }
        error(
            scene.surfaces_[region.surfaces[0]].line,
            fmt::format("the faces of the diffusing pane '{}' are not the same on both sides", scene.material(r).name),
            "give both sides the same corners and materials that light passes");
    }
}

}  // namespace exitance

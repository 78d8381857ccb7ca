#include "exitance/scene/emitter_groups.hpp"

#include <algorithm>
#include <map>

namespace exitance {
namespace {

EmitterGroup& group_named(std::vector<EmitterGroup>& groups, const std::string& name) {
    const auto at = std::find_if(groups.begin(), groups.end(), [&](const EmitterGroup& g) { return g.name == name; });
    if (at != groups.end()) return *at;
    groups.push_back({name, {}, {}, false});
    return groups.back();
}

}  // namespace

void part_emitters_by_group(SceneDescription& description) {
    std::map<std::uint32_t, std::uint32_t> first_group;  // first group found to use each material
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;
    for (SceneDescription::Face& face : description.faces) {
        if (face.material >= description.materials.size() || !description.materials[face.material].emits()) continue;
        if (first_group.emplace(face.material, face.group).first->second == face.group) continue;
        const auto [copy, is_new] = copies.emplace(std::pair(face.material, face.group),
                                                   static_cast<std::uint32_t>(description.materials.size()));
        if (is_new) description.materials.push_back(Material(description.materials[face.material]));
        face.material = copy->second;
    }
}

std::vector<EmitterGroup> find_emitter_groups(const Scene& scene) {
    std::vector<EmitterGroup> groups;
    for (const SurfaceId s : scene.emitters()) {
        const Surface& surface = scene.surfaces()[s];
        const std::string& name = surface.group.is_none() ? std::string() : scene.groups()[surface.group];
        EmitterGroup& group = group_named(groups, name.empty() ? "light" : name);
        if (std::find(group.materials.begin(), group.materials.end(), surface.material) == group.materials.end())
            group.materials.push_back(surface.material);
    }
    for (std::uint32_t i = 0; i < scene.lights().size(); ++i) {
        const std::string& name = scene.lights()[i].name;
        group_named(groups, name.empty() ? "light" : name).lights.push_back(i);
    }
    if (!scene.distant().empty()) group_named(groups, "sky").is_distant = true;
    return groups;
}

}  // namespace exitance

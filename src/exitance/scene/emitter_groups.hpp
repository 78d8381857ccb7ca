#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Gives the emitting faces of every group materials of their own (of the same name), so that faces of two groups never
/// become one region, and each group's light can be changed by itself.
void part_emitters_by_group(SceneDescription& description);

/// Light that is switched together: emitting faces of one group, a source without extent, or all distant light.
struct EmitterGroup {
    std::string name;
    std::vector<MaterialId> materials;
    std::vector<std::uint32_t> lights;  ///< Among Scene::lights().
    bool is_distant = false;
};

/// The groups of a scene whose emitters were parted: by name, in the order in which they first emit; then lights by
/// name, then "sky" where there is any distant light.
std::vector<EmitterGroup> find_emitter_groups(const Scene& scene);

}  // namespace exitance

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Gives the emitting faces of every group materials of their own (of the same name). Then faces of two groups never
/// become one region, and each group's light can be changed separately.
void part_emitters_by_group(SceneDescription& description);

/// Lights that are switched together: the emitting faces of one group, a punctual light, or all distant light.
struct EmitterGroup {
    std::string name;
    std::vector<MaterialId> materials;
    std::vector<std::uint32_t> lights;  ///< Indices into Scene::lights().
    bool is_distant = false;
};

/// Returns the groups of a scene after part_emitters_by_group(): named groups in the order of their first emitting
/// face, then lights by name, then "sky" if there is distant light.
std::vector<EmitterGroup> find_emitter_groups(const Scene& scene);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads glTF 2.0, as JSON (.gltf) or binary (.glb): the triangles of the default scene with their nodes' transforms,
/// (x, y, z) -> (x, -z, y), metres. A group is a node. Of a material: base colour times 1 - metalness is the
/// reflectance, at most 0.95; emissive factor times KHR_materials_emissive_strength the radiance; textures by their
/// means; double-sided ones become two faces. The winding decides which side is the front; under a mirroring transform
/// it is turned, as glTF says. KHR_lights_punctual become lights, cameras become views. What is left out is among the
/// findings. O(triangles).
ReadScene read_gltf(const std::string& path);

}  // namespace exitance

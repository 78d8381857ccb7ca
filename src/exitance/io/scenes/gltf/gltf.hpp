#pragma once

#include <optional>
#include <string>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// Reads glTF 2.0, as JSON (.gltf) or binary (.glb): the triangles of the default scene, with the transforms of their
/// nodes, in metres. Coordinates are converted to Z up: (x, y, z) -> (x, -z, y). Each node becomes a group.
/// Materials: the reflectance is the base colour times 1 - metalness, at most 0.95; the radiance is the emissive factor
/// times KHR_materials_emissive_strength. Textures give each face the mean of the part that it shows; faces are cut
/// where it varies. A double-sided triangle becomes two faces. The winding determines the front; it is reversed under a
/// mirroring transform, as glTF requires. KHR_lights_punctual become lights, cameras become views. The findings list
/// omitted parts. O(triangles). texture_parts  see `TexturedFaces`
ReadScene read_gltf(const std::string& path, std::optional<std::size_t> texture_parts = {});

}  // namespace exitance

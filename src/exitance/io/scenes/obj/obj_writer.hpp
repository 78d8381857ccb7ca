#pragma once

#include <span>
#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Writes a scene as OBJ, with an MTL file of the same name in the same folder. Reading restores all numbers exactly,
/// except emission, which is rounded. Each file appears whole or not at all. Error: cannot_write.
/// places  texture coordinates (vt) of the corners of all faces, in their order; (0, 0) is the upper left of a picture.
///         Empty: none
Result<void> write_obj(const SceneDescription& scene, const std::string& path, std::span<const Vec2> places = {});

/// Returns the polygons, materials and groups of a scene, with points that faces share.
SceneDescription describe_polygons(const Scene& scene);

}  // namespace exitance

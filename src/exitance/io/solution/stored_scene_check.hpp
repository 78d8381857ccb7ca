#pragma once

#include <optional>
#include <string>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Returns the reason why a scene from a file cannot have been made by make_scene: values out of range, normals or
/// areas that differ from those of the corners, regions that do not match their faces. Empty if the scene is valid.
/// Indices must be valid already. O(corners).
std::optional<std::string> find_nonsense(const Scene& scene);

/// Returns the reason why the roots of a tree cannot be elements of the scene: they are not in the plane of their
/// region, or are outside the scene. Empty if the tree is valid. O(roots).
std::optional<std::string> find_nonsense(const ElementTree& tree, const Scene& scene);

}  // namespace exitance

#pragma once

#include <optional>
#include <string>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Why a scene from a file is none that make_scene could have made: values out of range, normals and areas that are not
/// those of their corners, regions apart from their faces. Indices must be good already. Empty when nothing is wrong.
/// O(corners).
std::optional<std::string> find_nonsense(const Scene& scene);

/// Why the roots of a function from a file are none of the scene's elements: they lie off the plane of their region or
/// outside the scene. O(roots).
std::optional<std::string> find_nonsense(const ElementTree& tree, const Scene& scene);

}  // namespace exitance

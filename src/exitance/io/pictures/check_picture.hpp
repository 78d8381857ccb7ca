#pragma once

#include <span>

#include "exitance/io/pictures/png.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Draws a scene as its file defines it, valid or not, with the findings marked in colours: two parallel views from
/// above, from opposite sides. Faces are drawn only if their front is visible, so that the insides of rooms are
/// visible. Marks are on top of everything, and a legend lists their numbers. O(faces + pixels).
Image check_picture(const SceneDescription& scene, std::span<const Mark> marks, int width, int height);

}  // namespace exitance

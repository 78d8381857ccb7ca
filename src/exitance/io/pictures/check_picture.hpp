#pragma once

#include <span>

#include "exitance/io/pictures/png.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A picture of a scene as its file gives it, whether it can be used or not, with what was found marked in colours: two
/// parallel views from above, from opposite sides, faces drawn where their fronts are seen (so that one looks into
/// rooms), marks on top of everything, and a legend with how many there are of each. O(faces + pixels).
Image check_picture(const SceneDescription& scene, std::span<const Mark> marks, int width, int height);

}  // namespace exitance

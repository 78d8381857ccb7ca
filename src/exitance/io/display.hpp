#pragma once

#include <vector>

#include "exitance/io/png.hpp"
#include "exitance/io/tone_map.hpp"
#include "exitance/reconstruct/picture.hpp"

namespace exitance {

/// A picture as an eye might see it: radiosity through the tone map, sRGB. Backs of surfaces are nearly black, what
/// shows no surface is black.
Image display_image(const Picture& picture, const ToneMap& tones);

/// Darkens the marked pixels: the mesh over a picture.
void draw_edges(Image& image, const std::vector<bool>& edges);

}  // namespace exitance

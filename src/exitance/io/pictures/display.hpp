#pragma once

#include <cstddef>
#include <vector>

#include "exitance/io/pictures/png.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// Sets pixel number `i`, row by row, to a linear colour, whose values are limited to [0, 1].
void set_pixel(Image& image, std::size_t i, const DisplayColour& colour);

/// Exposure that brings reflected light to middle grey: 0.18 over the logarithmic mean of the picture, per W/m^2.
/// Emitters are ignored unless nothing else is visible.
double automatic_exposure(const Picture& picture);

/// Converts a picture for display: radiosity through the tone map, sRGB. Emitters in a pixel are tone mapped
/// separately, so that their edges stay smooth. Backs of surfaces are nearly black, and pixels without a surface are
/// black.
Image display_image(const Picture& picture, const ToneMap& tones);

/// Darkens the marked pixels, which are the edges of the mesh.
void draw_edges(Image& image, const std::vector<bool>& edges);

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/io/pictures/png.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// The scale at which what a picture shows of reflected light lies around middle grey: 0.18 over its logarithmic mean,
/// W/m^2 the unit. Emitters are left out, unless nothing else is to be seen.
double automatic_exposure(const Picture& picture);

/// A picture as an eye might see it: radiosity through the tone map, sRGB. Emitters in a pixel are toned by themselves,
/// so that their edges stay smooth. Backs of surfaces are nearly black, what shows no surface is black.
Image display_image(const Picture& picture, const ToneMap& tones);

/// Darkens the marked pixels: the mesh over a picture.
void draw_edges(Image& image, const std::vector<bool>& edges);

}  // namespace exitance

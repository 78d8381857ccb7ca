#pragma once

#include "exitance/io/pictures/false_colour.hpp"

namespace exitance {

/// Draws lines of equal illuminance at the steps of `scale`, through the light between pixels' middles, each surface by
/// itself, with their values on the longer ones, and in the lower left corner `title`, which says what they show.
void draw_isolux(Image& image, const Picture& picture, const ColourScale& scale, const std::string& title);

}  // namespace exitance

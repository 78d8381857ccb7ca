#pragma once

#include "exitance/io/pictures/false_colour.hpp"

namespace exitance {

/// Draws lines of equal illuminance where it passes the steps of `scale`, each surface by itself, with their values on
/// the longer ones, and in the lower left corner what they show. lx; in scenes given in W/(m^2 sr) weighted W/m^2.
void draw_isolux(Image& image, const Picture& picture, const ColourScale& scale);

}  // namespace exitance

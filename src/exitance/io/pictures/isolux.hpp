#pragma once

#include "exitance/io/pictures/false_colour.hpp"

namespace exitance {

/// Draws isolines of a quantity at the steps of `scale`, interpolated between pixel centres, separately for each
/// surface. Longer lines are labelled with their values; `caption` is in the lower left corner.
void draw_isolux(Image& image, const Picture& picture, Quantity quantity, const ColourScale& scale,
                 const std::string& caption);

}  // namespace exitance

#pragma once

#include <array>
#include <string_view>

#include "exitance/io/pictures/png.hpp"

namespace exitance {

using Rgb = std::array<std::uint8_t, 3>;

/// Width of a text in pixels at a whole-numbered scale; its height is 7 scale.
int text_width(std::string_view text, int scale);

/// Writes a text with its upper left corner at (x, y): digits, small letters, W and . / - ^2 ("^2" is a raised 2).
/// What has no glyph leaves a gap. Pixels outside the picture are left out.
void draw_text(Image& image, int x, int y, std::string_view text, int scale, Rgb colour);

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);

}  // namespace exitance

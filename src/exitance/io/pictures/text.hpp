#pragma once

#include <array>
#include <string_view>

#include "exitance/io/pictures/png.hpp"

namespace exitance {

using Rgb = std::array<std::uint8_t, 3>;

/// Width of a text in pixels at an integer scale. Its height is 7 * scale pixels.
int text_width(std::string_view text, int scale);

/// Draws a text with its upper left corner at (x, y): digits, small letters, W and . / - ^2 ("^2" is a raised 2).
/// Characters without a glyph leave a gap. Pixels outside the picture are ignored.
void draw_text(Image& image, int x, int y, std::string_view text, int scale, Rgb colour);

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);

}  // namespace exitance

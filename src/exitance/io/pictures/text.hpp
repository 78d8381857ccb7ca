#pragma once

#include <array>
#include <string_view>

#include "exitance/io/pictures/png.hpp"

namespace exitance {

using Rgb = std::array<std::uint8_t, 3>;

/// Width of a text in pixels, in DejaVu Sans with `size` pixels per em. Capital letters and digits are 0.73 `size`
/// high.
int text_width(std::string_view text, int size);

/// Draws a text in UTF-8, with letters up to U+07FF, with smooth borders. (x, y) is the upper left corner of its first
/// capital letter, in pixels; "^2" becomes a raised 2. Pixels outside the picture are ignored. The pixels are the same
/// on every machine that has the same version of FreeType. About 0.1 ms per text.
void draw_text(Image& image, int x, int y, std::string_view text, int size, Rgb colour);

void fill_rectangle(Image& image, int x, int y, int width, int height, Rgb colour);

}  // namespace exitance

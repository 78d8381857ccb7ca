#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// A picture with eight bits per channel, sRGB: red, green, blue, rows from top to bottom.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;

    Image(int w, int h) : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    std::uint8_t* at(int x, int y) {
        const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
        return rgb.data() + 3 * (row + static_cast<std::size_t>(x));
    }
    const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// Texts stored with a picture (tEXt), as pairs of keyword and text. Latin-1.
using ImageTexts = std::vector<std::pair<std::string, std::string>>;

/// Encodes a picture as PNG.
Result<std::string> encode_png(const Image& image, const ImageTexts& texts);

/// Writes a PNG file, which appears whole or not at all.
Result<void> write_png(const std::string& path, const Image& image, const ImageTexts& texts);

}  // namespace exitance

#include "exitance/io/display.hpp"

#include <cmath>

#include "exitance/core/parallel.hpp"

namespace exitance {

Image display_image(const Picture& picture, const ToneMap& tones) {
    constexpr double back_of_surface = 0.02;  // linear: told apart from nothing, and from anything lit
    Image image(picture.size.width, picture.size.height);
    parallel_for(picture.pixels.size(), 1024, [&](std::size_t i) {
        const Pixel& pixel = picture.pixels[i];
        const DisplayColour front = tones(pixel.radiosity);
        for (std::size_t c = 0; c < 3; ++c) {
            const double linear = pixel.front * front[c] + pixel.back * back_of_surface;
            image.rgb[3 * i + c] = static_cast<std::uint8_t>(std::lround(255 * srgb_encoded(linear)));
        }
    });
    return image;
}

void draw_edges(Image& image, const std::vector<bool>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (edges[i])
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) image.rgb[k] = static_cast<std::uint8_t>(image.rgb[k] / 2);
}

}  // namespace exitance

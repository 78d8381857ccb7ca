#include "exitance/io/pictures/display.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"

namespace exitance {

namespace {

/// Radiosity of the non-emitting surfaces in a pixel, times their share of the pixel.
Spectrum reflected(const Pixel& pixel) {
    Spectrum light = pixel.front * pixel.radiosity - pixel.emitting * pixel.from_lamps;
    for (double& value : light.value) value = std::max(value, 0.0);  // removes rounding errors below 0
    return light;
}

}  // namespace

void set_pixel(Image& image, std::size_t i, const DisplayColour& colour) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = srgb_encoded(std::clamp(colour[c], 0.0, 1.0));
        image.rgb[3 * i + c] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
}

double automatic_exposure(const Picture& picture) {
    double sum = 0, weight = 0, lamps = 0;
    for (const Pixel& pixel : picture.pixels) {
        const double share = pixel.front - pixel.emitting;
        lamps = std::max(lamps, mean(pixel.from_lamps));
        if (share < 0.01) continue;
        const double light = mean(reflected(pixel)) / share;
        if (light > 0) sum += share * std::log(light), weight += share;
    }
    if (weight > 0) return 0.18 / std::exp(sum / weight);
    return lamps > 0 ? 0.5 / lamps : 1;
}

Image display_image(const Picture& picture, const ToneMap& tones) {
    constexpr double back_of_surface = 0.02;  // linear; distinguishable from black and from anything lit
    Image image(picture.size.width, picture.size.height);
    parallel_for(picture.pixels.size(), 1024, [&](std::size_t i) {
        const Pixel& pixel = picture.pixels[i];
        const double share = pixel.front - pixel.emitting;
        const DisplayColour surfaces = share > 0 ? tones(reflected(pixel) / share) : DisplayColour();
        const DisplayColour lamps = tones(pixel.from_lamps);
        DisplayColour linear{};
        for (std::size_t c = 0; c < 3; ++c)
            linear[c] = share * surfaces[c] + pixel.emitting * lamps[c] + pixel.back * back_of_surface;
        set_pixel(image, i, linear);
    });
    return image;
}

void draw_edges(Image& image, const std::vector<bool>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (edges[i])
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) image.rgb[k] = static_cast<std::uint8_t>(image.rgb[k] / 2);
}

}  // namespace exitance

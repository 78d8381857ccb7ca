#include "exitance/io/export/viewer_frame.hpp"

#include <cstdint>
#include <vector>

#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {

std::string viewer_frame(const Picture& picture, const LightUnit& own) {
    const auto [width, height] = picture.size;
    std::vector<float> light, rest;
    light.reserve(4 * picture.pixels.size()), rest.reserve(2 * picture.pixels.size());
    for (int y = height - 1; y >= 0; --y) {
        for (int x = 0; x < width; ++x) {
            const Pixel& pixel = picture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                static_cast<std::size_t>(x)];
            for (const double c : red_green_blue(pixel.radiosity)) light.push_back(static_cast<float>(c));
            light.push_back(pixel.front);
            rest.push_back(static_cast<float>(own(pixel.irradiance))), rest.push_back(pixel.back);
        }
    }
    const std::vector<std::uint32_t> size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    std::string out = "EXF1";
    out.append(reinterpret_cast<const char*>(size.data()), 4 * size.size());
    out.append(reinterpret_cast<const char*>(light.data()), 4 * light.size());
    out.append(reinterpret_cast<const char*>(rest.data()), 4 * rest.size());
    return out;
}

}  // namespace exitance

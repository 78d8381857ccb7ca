#include "exitance/io/pictures/linear_image.hpp"

#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {

LinearImage linear_image(const Picture& picture) {
    LinearImage image{picture.size.width, picture.size.height, {}};
    for (const char* name : {"R", "G", "B", "A", "irradiance.R", "irradiance.G", "irradiance.B"})
        image.channels.push_back({name, std::vector<float>(picture.pixels.size())});
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const Pixel& pixel = picture.pixels[i];
        const auto radiance = red_green_blue(radiance_of_exitance(pixel.front * pixel.radiosity));
        const auto irradiance = red_green_blue(pixel.irradiance);
        for (std::size_t c = 0; c < 3; ++c) {
            image.channels[c].values[i] = static_cast<float>(radiance[c]);
            image.channels[4 + c].values[i] = static_cast<float>(irradiance[c]);
        }
        image.channels[3].values[i] = pixel.front + pixel.back;
    }
    return image;
}

}  // namespace exitance

#include "exitance/io/pictures/read_directional.hpp"

#include <fmt/format.h>

#include <array>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {

Result<void> check_directional_size(long long width, long long height, const std::string& path) {
    if (width < 1 || height < 1 || width != 2 * height)
        return Error{ErrorCode::bad_input,
                     fmt::format("the picture has {} x {} pixels, but a sky needs one that is twice as wide as high",
                                 width, height),
                     path, "use an equirectangular picture of all directions"};
    if (width > static_cast<long long>(max_directional_width))
        return Error{ErrorCode::bad_input,
                     fmt::format("the picture is {} pixels wide, more than {}", width, max_directional_width), path,
                     "reduce it, for instance with Radiance's `pfilt -1 -x 4096 -y 2048`"};
    return {};
}

void append_pixel(float r, float g, float b, DirectionalPicture& picture) {
    const std::array<float, 3> rgb{r, g, b};
    if (bands == 1) return picture.radiance.push_back((r + g + b) / 3);
    for (std::size_t band = 0; band < bands; ++band) picture.radiance.push_back(rgb[band * 3 / bands]);
}

Result<DirectionalPicture> read_directional_picture(const std::string& path) {
    const std::string end = ending(path);
    if (end != ".hdr" && end != ".exr")
        return Error{ErrorCode::bad_input,
                     end.empty() ? std::string("the picture of a sky has no file name ending")
                                 : fmt::format("a picture in {} holds no radiances", end),
                     path, "use .hdr (Radiance RGBE) or .exr (OpenEXR); .png and .jpg clip the light of sun and sky"};
    Result<DirectionalPicture> picture = end == ".hdr" ? read_directional_hdr(path) : read_directional_exr(path);
    if (!picture) return picture;
    constexpr float largest = 1e15F;  // far above the sun's radiance, 2e7 W/(m^2 sr); squares stay finite
    for (std::size_t i = 0; i < picture->radiance.size(); ++i) {
        const float value = picture->radiance[i];
        if (value >= 0 && value <= largest) continue;
        const std::size_t pixel = i / bands;
        return Error{ErrorCode::bad_input,
                     fmt::format("the pixel in column {}, row {} is {}, not a radiance from 0 to {:g} W/(m^2 sr)",
                                 pixel % picture->width + 1, pixel / picture->width + 1, value, largest),
                     path, "repair the picture in the program that made it"};
    }
    return picture;
}

}  // namespace exitance

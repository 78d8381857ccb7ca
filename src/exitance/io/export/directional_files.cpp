#include "exitance/io/export/directional_files.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/io/pictures/png.hpp"
#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

const char* unit_of_coefficients(const Scene& scene) {
    return scene.is_photometric() ? "cd/m^2" : "W/(m^2 sr)";
}

LinearImage empty_image(const LightMap& light) {
    LinearImage image{light.size.width, light.size.height, {}};
    for (const char* name : {"R", "G", "B"}) image.channels.push_back({name, std::vector<float>(light.size.texels())});
    return image;
}

Result<void> write_coefficients(const LightMap& light, const std::vector<std::string>& names, const Scene& scene,
                                const LightMapFormat& format, const std::string& folder) {
    for (std::size_t k = 0; k < names.size(); ++k) {
        LinearImage image = empty_image(light);
        for (std::size_t i = 0; i < light.size.texels(); ++i) {
            const auto rgb = red_green_blue(radiance_of(directed_at(light, i))[k]);
            for (std::size_t c = 0; c < 3; ++c) image.channels[c].values[i] = static_cast<float>(rgb[c]);
        }
        const ImageFacts facts{
            {"software", "exitance"},
            {"units", fmt::format("R, G, B: coefficient {} of radiance in {}", k, unit_of_coefficients(scene))}};
        const Result<void> written = write_exr(folder + "/" + names[k], image, facts, format.precision);
        if (!written) return written;
    }
    return {};
}

Result<void> write_direction(const LightMap& light, const std::vector<std::string>& names, const LightMapFormat& format,
                             const std::string& folder) {
    LinearImage image = empty_image(light);
    Image picture(light.size.width, light.size.height);
    for (std::size_t i = 0; i < light.size.texels(); ++i) {
        const DominantDirection found = dominant_direction(directed_at(light, i));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double value = found.share * found.direction[axis];
            image.channels[axis].values[i] = static_cast<float>(value);
            picture.rgb[3 * i + axis] = static_cast<std::uint8_t>(std::lround(255 * (0.5 + 0.5 * value)));
        }
    }
    const std::string meaning = "X, Y, Z in the scene's axes: dominant direction times its share of the light";
    const ImageFacts facts{{"software", "exitance"}, {"units", "R, G, B: " + meaning}};
    const Result<void> written = write_exr(folder + "/" + names[0], image, facts, format.precision);
    if (!written) return written;
    return write_png(folder + "/" + names[1], picture,
                     ImageTexts{{"Software", "exitance"}, {"Content", meaning + ", from -1 to 1"}});
}

}  // namespace

std::vector<std::string> directional_files(std::size_t map, std::optional<std::size_t> group,
                                           const LightMapFormat& format) {
    const std::string stem = light_map_stem(map, group);
    if (format.directions == Directions::none) return {};
    if (format.directions == Directions::dominant) return {stem + "_direction.exr", stem + "_direction.png"};
    std::vector<std::string> names;
    for (std::size_t k = 0; k < 4; ++k) names.push_back(fmt::format("{}_sh{}.exr", stem, k));
    return names;
}

Result<void> write_directional(const LightMap& light, std::size_t map, std::optional<std::size_t> group,
                               const Scene& scene, const LightMapFormat& format, const std::string& folder) {
    if (!light.has_directions() || format.directions == Directions::none) return {};
    const std::vector<std::string> names = directional_files(map, group, format);
    return format.directions == Directions::sh ? write_coefficients(light, names, scene, format, folder)
                                               : write_direction(light, names, format, folder);
}

std::string directional_list(std::size_t map, std::optional<std::size_t> group, const LightMapFormat& format) {
    std::string list;
    for (const std::string& name : directional_files(map, group, format))
        list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
    return list;
}

std::string directional_json(const Scene& scene, const LightMapFormat& format) {
    if (format.directions == Directions::none) return {};
    if (format.directions == Directions::dominant)
        return "\n  \"directional\": {\"form\": \"dominant\", \"axes\": \"scene\"},";
    return fmt::format(
        "\n  \"directional\": {{\"form\": \"sh\", \"axes\": \"scene\", \"unit\": \"{}\", \"irradiance_factors\": "
        "[{}, {}]}},",
        unit_of_coefficients(scene), irradiance_factors[0], irradiance_factors[1]);
}

}  // namespace exitance

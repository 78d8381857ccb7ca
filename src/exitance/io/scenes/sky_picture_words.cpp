#include "exitance/io/scenes/sky_picture_words.hpp"

#include <fmt/format.h>

#include <optional>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/pictures/read_directional.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

constexpr std::string_view first_word = "image=";
constexpr double max_rotation = 360, max_scale = 1e9;

Error wrong_word(std::string message, std::string hint = "such as image=sky.hdr,rotation=90,scale=1") {
    return {ErrorCode::usage, std::move(message), "--sky", std::move(hint)};
}

struct PictureWords {
    std::string path;
    std::optional<double> rotation, scale;
};

/// Parses "rotation=90" or "scale=2".
Result<void> read_number(const std::string& word, PictureWords& out) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    if (equals == word.npos || (name != "rotation" && name != "scale"))
        return wrong_word(fmt::format("'{}' does not apply to a picture", shown(word)),
                          "image=FILE takes rotation (degrees) and scale; the file's name must not contain a comma");
    std::optional<double>& to = name == "rotation" ? out.rotation : out.scale;
    if (to) return wrong_word(fmt::format("'{}' is given twice", name));
    const std::optional<double> value = parse_number(word.substr(equals + 1));
    if (!value) return wrong_word(fmt::format("{} '{}' is not a number", name, shown(word.substr(equals + 1))));
    if (name == "rotation" && !(*value >= -max_rotation && *value <= max_rotation))
        return wrong_word(fmt::format("rotation is {}, not from -360 to 360 degrees", *value));
    if (name == "scale" && !(*value > 0 && *value <= max_scale))
        return wrong_word(fmt::format("scale is {}, not a factor above 0 and at most {:g}", *value, max_scale));
    to = value;
    return {};
}

Result<PictureWords> read_picture_words(const std::string& text) {
    PictureWords out;
    const std::vector<std::string> words = split_at_commas(text);
    out.path = words.front().substr(first_word.size());
    for (std::size_t i = 1; i < words.size(); ++i)
        if (const Result<void> read = read_number(words[i], out); !read) return read.error();
    if (out.path.empty()) return wrong_word("the picture's file is missing after image=");
    return out;
}

void multiply(double factor, DistantLight& light) {
    for (DistantLight::Dome& dome : light.domes) dome.irradiance *= factor;
    for (DistantLight::Disc& disc : light.discs) disc.irradiance *= factor;
}

}  // namespace

bool is_picture_sky(const std::string& words) {
    return words.starts_with(first_word);
}

Result<ChosenSky> parse_picture_sky(const std::string& text) {
    const Result<PictureWords> words = read_picture_words(text);
    if (!words) return words.error();
    Result<DirectionalPicture> picture = read_directional_picture(words->path);
    if (!picture) return picture.error();
    ChosenSky out;
    out.in_watts = light_of_picture(std::move(*picture), words->rotation.value_or(0));
    multiply(words->scale.value_or(1), out.in_watts);
    if (out.in_watts.empty())
        return Error{ErrorCode::bad_input, "the picture is black", words->path, "use a picture with light"};
    out.in_lumens = out.in_watts;
    multiply(daylight_efficacy, out.in_lumens);
    return out;
}

}  // namespace exitance

#include "exitance/io/scenes/textures/texture_mean.hpp"

#include <cmath>

namespace exitance {
namespace {

ByteCurve make_srgb() {
    ByteCurve out{};
    for (std::size_t i = 0; i < 256; ++i) {
        const double v = static_cast<double>(i) / 255;
        out.value[i] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return out;
}

ByteCurve make_linear() {
    ByteCurve out{};
    for (std::size_t i = 0; i < 256; ++i) out.value[i] = static_cast<double>(i) / 255;
    return out;
}

}  // namespace

const ByteCurve& srgb_curve() {
    static const ByteCurve curve = make_srgb();
    return curve;
}

const ByteCurve& linear_curve() {
    static const ByteCurve curve = make_linear();
    return curve;
}

namespace {

bool is_png(std::span<const std::uint8_t> file) {
    return file.size() > 8 && file[0] == 0x89 && file[1] == 'P' && file[2] == 'N' && file[3] == 'G';
}
bool is_jpeg(std::span<const std::uint8_t> file) {
    return file.size() > 3 && file[0] == 0xff && file[1] == 0xd8;
}
const Error unknown{ErrorCode::bad_input, "is neither a PNG nor a JPEG", "", ""};

}  // namespace

Result<std::array<double, 3>> mean_colour(std::span<const std::uint8_t> file, const ByteCurve& decode) {
    if (is_png(file)) return mean_of_png(file, decode);
    if (is_jpeg(file)) return mean_of_jpeg(file, decode);
    return unknown;
}

Result<TexturePixels> decode_texture(std::span<const std::uint8_t> file) {
    if (is_png(file)) return decode_png(file);
    if (is_jpeg(file)) return decode_jpeg(file);
    return unknown;
}

}  // namespace exitance

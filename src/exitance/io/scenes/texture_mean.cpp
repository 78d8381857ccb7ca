#include "exitance/io/scenes/texture_mean.hpp"

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

Result<std::array<double, 3>> mean_colour(std::span<const std::uint8_t> file, const ByteCurve& decode) {
    if (file.size() > 8 && file[0] == 0x89 && file[1] == 'P' && file[2] == 'N' && file[3] == 'G')
        return mean_of_png(file, decode);
    if (file.size() > 3 && file[0] == 0xff && file[1] == 0xd8) return mean_of_jpeg(file, decode);
    return Error{ErrorCode::bad_input, "is neither a PNG nor a JPEG", "", ""};
}

}  // namespace exitance

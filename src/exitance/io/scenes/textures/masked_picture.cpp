#include "exitance/io/scenes/textures/masked_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace exitance {
namespace {

constexpr int opaque = 255;

/// A picture that is white where opacities are at least `cutoff`, else black.
TexturePixels mask_of(const TexturePixels& pixels, std::span<const std::uint8_t> opacity, double cutoff) {
    TexturePixels out{pixels.width, pixels.height, {}};
    for (const std::uint8_t a : opacity)
        out.rgb.insert(out.rgb.end(), 3, static_cast<std::uint8_t>(a >= cutoff * opaque ? opaque : 0));
    return out;
}

/// Gives pixels that are black in a mask the mean colour of the rest.
void fill_holes(TexturePixels& pixels, const TexturePixels& mask) {
    std::array<double, 3> sum{};
    double count = 0;
    for (std::size_t i = 0; i < mask.rgb.size(); ++i)
        if (mask.rgb[i] > 0) sum[i % 3] += pixels.rgb[i], count += 1.0 / 3;
    if (!(count > 0)) return;
    for (std::size_t i = 0; i < mask.rgb.size(); ++i)
        if (mask.rgb[i] == 0) pixels.rgb[i] = static_cast<std::uint8_t>(std::lround(sum[i % 3] / count));
}

}  // namespace

void fill_holes(TexturePixels& pixels, double cutoff) {
    fill_holes(pixels, mask_of(pixels, pixels.opacity, cutoff));
}

Result<std::optional<MaskedPicture>> decode_masked(std::span<const std::uint8_t> file, double cutoff,
                                                   const ByteCurve& decode) {
    Result<TexturePixels> pixels = decode_texture(file);
    if (!pixels) return pixels.error();
    const TexturePixels mask = mask_of(*pixels, pixels->opacity, cutoff);
    if (std::all_of(mask.rgb.begin(), mask.rgb.end(), [](std::uint8_t v) { return v > 0; }))
        return std::optional<MaskedPicture>();
    fill_holes(*pixels, mask);
    return std::optional<MaskedPicture>({TextureArea::of(*pixels, decode), TextureArea::of(mask, linear_curve())});
}

Result<TextureArea> decode_coverage(std::span<const std::uint8_t> file, double cutoff) {
    Result<TexturePixels> pixels = decode_texture(file);
    if (!pixels) return pixels.error();
    if (pixels->width == 0 || pixels->height == 0) return Error{ErrorCode::bad_input, "is empty", "", ""};
    if (pixels->opacity.empty())
        for (std::size_t i = 0; i < pixels->rgb.size(); i += 3) pixels->opacity.push_back(pixels->rgb[i]);
    return TextureArea::of(mask_of(*pixels, pixels->opacity, cutoff), linear_curve());
}

}  // namespace exitance

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// A value for each of the 256 values of a byte, such as the linear light of an sRGB value.
struct ByteCurve {
    std::array<double, 256> value;
};

/// Computes the mean red, green and blue of a picture (PNG or JPEG), each in [0, 1], after applying `decode` to every
/// value. Grey counts as three equal channels; opacity is ignored. Pictures are decoded row by row in little memory,
/// except JPEGs with several scans, which are held whole (up to 512 MiB). Error: pictures of more than 2^26 pixels
/// (8192 x 8192), and files that cannot be decoded.
Result<std::array<double, 3>> mean_colour(std::span<const std::uint8_t> file, const ByteCurve& decode);

/// Versions of mean_colour() for one format.
Result<std::array<double, 3>> mean_of_png(std::span<const std::uint8_t> file, const ByteCurve& decode);
Result<std::array<double, 3>> mean_of_jpeg(std::span<const std::uint8_t> file, const ByteCurve& decode);

/// The sRGB decoding curve and the linear one.
const ByteCurve& srgb_curve();
const ByteCurve& linear_curve();

/// Accumulates the mean of rows of pixels, three bytes per pixel.
class MeanOfRows {
  public:
    explicit MeanOfRows(const ByteCurve& decode) : decode_(&decode) {}
    void add(const std::uint8_t* rgb, std::size_t pixels) {
        std::array<double, 3> sum{};
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t c = 0; c < 3; ++c) sum[c] += decode_->value[rgb[3 * i + c]];
        for (std::size_t c = 0; c < 3; ++c) sum_[c] += sum[c];
        count_ += pixels;
    }
    std::array<double, 3> mean() const {
        const double n = count_ > 0 ? static_cast<double>(count_) : 1;
        return {sum_[0] / n, sum_[1] / n, sum_[2] / n};
    }

  private:
    const ByteCurve* decode_;
    std::array<double, 3> sum_{};
    std::size_t count_ = 0;
};

/// A decoded picture, three bytes per pixel with the file's coding, rows from top to bottom. Limits as for
/// mean_colour().
struct TexturePixels {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    std::vector<std::uint8_t> opacity = {};  ///< Opacity, one byte per pixel; empty: opaque.
};
Result<TexturePixels> decode_texture(std::span<const std::uint8_t> file);
Result<TexturePixels> decode_png(std::span<const std::uint8_t> file);
Result<TexturePixels> decode_jpeg(std::span<const std::uint8_t> file);

/// Larger pictures are rejected: a small file can claim any size.
inline constexpr std::uint64_t max_texture_pixels = std::uint64_t(1) << 26;

}  // namespace exitance

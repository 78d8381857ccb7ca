#include "exitance/io/scenes/textures/texture_area.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr std::size_t max_held_pixels = std::size_t(1) << 22;  ///< Limit on the pixels of the finest level.
constexpr int samples_per_side = 32;
constexpr double golden = 0.6180339887498949;

/// Index of the pixel at a texture coordinate, in a row of `count` pixels.
std::size_t pixel(double place, std::size_t count, TextureArea::Wrap wrap) {
    double t = std::isfinite(place) ? place : 0;
    if (wrap == TextureArea::Wrap::clamp) t = std::clamp(t, 0.0, 1.0);
    if (wrap == TextureArea::Wrap::repeat) t -= std::floor(t);
    if (wrap == TextureArea::Wrap::mirror) t = std::abs(t - 2 * std::round(0.5 * t));
    return std::min(count - 1, static_cast<std::size_t>(t * static_cast<double>(count)));
}

/// Averages blocks of `factor` x `factor` pixels; the last blocks of rows and columns may be smaller. `value(x, y,
/// channel)` returns a pixel's value.
template <class Value>
std::vector<std::uint16_t> means_of_blocks(std::size_t width, std::size_t height, std::size_t factor, Value&& value) {
    std::vector<std::uint16_t> out;
    for (std::size_t y = 0; y < height; y += factor)
        for (std::size_t x = 0; x < width; x += factor) {
            const std::size_t end_x = std::min(width, x + factor), end_y = std::min(height, y + factor);
            const double count = static_cast<double>((end_x - x) * (end_y - y));
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0;
                for (std::size_t j = y; j < end_y; ++j)
                    for (std::size_t i = x; i < end_x; ++i) sum += value(i, j, c);
                out.push_back(static_cast<std::uint16_t>(std::lround(sum / count)));
            }
        }
    return out;
}

}  // namespace

Result<TextureArea> TextureArea::of(std::span<const std::uint8_t> file, const ByteCurve& decode) {
    const Result<TexturePixels> pixels = decode_texture(file);
    if (!pixels) return pixels.error();
    if (pixels->width == 0 || pixels->height == 0) return Error{ErrorCode::bad_input, "is empty", "", ""};
    return of(*pixels, decode);
}

TextureArea TextureArea::of(const TexturePixels& pixels, const ByteCurve& decode) {
    TextureArea out;
    std::size_t factor = 1;
    while (pixels.width * pixels.height / (factor * factor) > max_held_pixels) factor *= 2;
    const auto halved = [](std::size_t n, std::size_t by) { return (n + by - 1) / by; };
    out.levels_.push_back(
        {halved(pixels.width, factor), halved(pixels.height, factor),
         means_of_blocks(pixels.width, pixels.height, factor, [&](std::size_t x, std::size_t y, std::size_t c) {
             return 65535 * decode.value[pixels.rgb[3 * (y * pixels.width + x) + c]];
         })});
    while (std::max(out.levels_.back().width, out.levels_.back().height) > 1) {
        const Level& fine = out.levels_.back();
        Level half{halved(fine.width, 2), halved(fine.height, 2),
                   means_of_blocks(fine.width, fine.height, 2, [&](std::size_t x, std::size_t y, std::size_t c) {
                       return static_cast<double>(fine.rgb[3 * (y * fine.width + x) + c]);
                   })};
        out.levels_.push_back(std::move(half));
    }
    MeanOfRows mean(decode);
    for (std::size_t y = 0; y < pixels.height; ++y) mean.add(pixels.rgb.data() + 3 * y * pixels.width, pixels.width);
    out.mean_ = mean.mean();
    return out;
}

TextureArea::Wrap TextureArea::wrap_of(int number) {
    constexpr int clamp = 33071, mirror = 33648;
    return number == clamp ? Wrap::clamp : number == mirror ? Wrap::mirror : Wrap::repeat;
}

TextureArea::Colour TextureArea::smoothed(const Vec2& place, double size, Wrap wrap_s, Wrap wrap_t) const {
    const double wanted = std::clamp(std::log2(std::max(size, 1.0)), 0.0, static_cast<double>(levels_.size() - 1));
    const Level& level = levels_[static_cast<std::size_t>(std::lround(wanted))];
    const auto width = static_cast<double>(level.width), height = static_cast<double>(level.height);
    const double u = place.x * width - 0.5, i = std::floor(u), v = place.y * height - 0.5, j = std::floor(v);
    Colour sum{};
    for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a) {
            const double weight = (a == 0 ? i + 1 - u : u - i) * (b == 0 ? j + 1 - v : v - j);
            const Colour here = level.at(pixel((i + a + 0.5) / width, level.width, wrap_s),
                                         pixel((j + b + 0.5) / height, level.height, wrap_t));
            for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * here[c];
        }
    return sum;
}

/// The coarsest level whose pixels are not wider than `step` in either direction: coarser pixels would include light
/// from outside the face.
const TextureArea::Level& TextureArea::level_for(const Vec2& step) const {
    const Level& finest = levels_.front();
    const double pixels =
        std::min(step.x * static_cast<double>(finest.width), step.y * static_cast<double>(finest.height));
    const double level = pixels > 1 ? std::floor(std::log2(pixels)) : 0;
    return levels_[static_cast<std::size_t>(std::min(level, static_cast<double>(levels_.size() - 1)))];
}

namespace {

/// Accumulates mean, deviation and range of colours.
class ColourSum {
  public:
    void add(const TextureArea::Colour& colour) {
        for (std::size_t c = 0; c < 3; ++c) {
            const double v = colour[c];
            sum_[c] += v, squares_[c] += v * v;
            lowest_[c] = count_ == 0 ? v : std::min(lowest_[c], v);
            highest_[c] = count_ == 0 ? v : std::max(highest_[c], v);
        }
        ++count_;
    }
    std::size_t count() const { return count_; }
    TextureArea::Part part() const {
        TextureArea::Part out{{}, {}, lowest_, highest_};
        const auto n = static_cast<double>(count_);
        for (std::size_t c = 0; c < 3; ++c) {
            out.mean[c] = sum_[c] / n;
            const bool is_even = lowest_[c] == highest_[c];  // the difference of squares would be a rounding error
            out.deviation[c] = is_even ? 0 : std::sqrt(std::max(0.0, squares_[c] / n - out.mean[c] * out.mean[c]));
        }
        return out;
    }

  private:
    TextureArea::Colour sum_{}, squares_{}, lowest_{}, highest_{};
    std::size_t count_ = 0;
};

TextureArea::Part even_part(const TextureArea::Colour& colour) {
    return {colour, {}, colour, colour};
}

}  // namespace

TextureArea::Part TextureArea::part(std::span<const Vec2> outline, Wrap wrap_s, Wrap wrap_t) const {
    constexpr double max_coordinate = 1e6;  // farther coordinates have rounding errors of up to a pixel
    Vec2 low{max_coordinate, max_coordinate}, high{-max_coordinate, -max_coordinate}, middle;
    for (const Vec2& p : outline) {
        if (!(std::abs(p.x) < max_coordinate && std::abs(p.y) < max_coordinate)) return even_part(mean_);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)}, high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        middle = middle + (1.0 / static_cast<double>(outline.size())) * p;
    }
    if (outline.empty()) return even_part(mean_);
    const Vec2 step = (1.0 / samples_per_side) * (high - low);
    const Level& level = level_for(step);
    ColourSum sum;
    std::vector<double> crossings;
    for (int j = 0; j < samples_per_side; ++j) {
        const double y = low.y + (j + 0.5) * step.y;
        crossings.clear();
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
            if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
        }
        std::sort(crossings.begin(), crossings.end());
        // Each row is shifted by the golden ratio, so that the samples do not align with a pattern in the picture.
        const double shift = (j + 0.5) * golden - std::floor((j + 0.5) * golden);
        for (int i = 0; i < samples_per_side; ++i) {
            const double x = low.x + (i + shift) * step.x;
            const auto left = std::lower_bound(crossings.begin(), crossings.end(), x) - crossings.begin();
            if (left % 2 == 0) continue;
            sum.add(level.at(pixel(x, level.width, wrap_s), pixel(y, level.height, wrap_t)));
        }
    }
    if (sum.count() == 0)
        return even_part(level.at(pixel(middle.x, level.width, wrap_s), pixel(middle.y, level.height, wrap_t)));
    return sum.part();
}

}  // namespace exitance

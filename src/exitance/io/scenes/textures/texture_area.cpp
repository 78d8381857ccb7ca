#include "exitance/io/scenes/textures/texture_area.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr std::size_t max_held_pixels = std::size_t(1) << 22;  ///< Limit on the pixels of the finest level.
constexpr int samples_per_side = 32;
constexpr double golden = 0.6180339887498949;

/// Number of pixels in a row that is `across` pixels long; the last one may be cut off.
std::size_t pixel_count(double across) {
    return static_cast<std::size_t>(std::ceil(across));
}

/// Index of the pixel at a texture coordinate, in a row that is `across` pixels long.
std::size_t pixel(double place, double across, TextureArea::Wrap wrap) {
    double t = std::isfinite(place) ? place : 0;
    if (wrap == TextureArea::Wrap::clamp) t = std::clamp(t, 0.0, 1.0);
    if (wrap == TextureArea::Wrap::repeat) t -= std::floor(t);
    if (wrap == TextureArea::Wrap::mirror) t = std::abs(t - 2 * std::round(0.5 * t));
    return std::min(pixel_count(across) - 1, static_cast<std::size_t>(t * across));
}

/// Pixels that a stretch of texture coordinates covers, with their shares of it, which add up to 1.
using PixelShares = std::vector<std::pair<std::size_t, double>>;

PixelShares shares_of(double from, double to, double across, TextureArea::Wrap wrap) {
    PixelShares out;
    const std::size_t last = pixel_count(across) - 1;
    // The mean over many repetitions is that of one.
    constexpr double many_periods = 4;
    if (wrap != TextureArea::Wrap::clamp && to - from > many_periods) from = 0, to = 1;
    const double length = to - from;
    for (double t = from; t < to;) {
        const double period = std::floor(t), local = t - period;
        const bool is_mirrored = wrap == TextureArea::Wrap::mirror && std::fmod(std::abs(period), 2) != 0;
        std::size_t i = 0;
        double end = 0;
        if (wrap == TextureArea::Wrap::clamp && (t < 0 || t >= 1)) {
            i = t < 0 ? 0 : last, end = t < 0 ? std::min(0.0, to) : to;
        } else if (is_mirrored) {
            const auto after = static_cast<std::size_t>(std::max(1.0, std::ceil((1 - local) * across)));
            i = std::min(last, after - 1), end = period + 1 - static_cast<double>(i) / across;
        } else {
            i = std::min(last, static_cast<std::size_t>(local * across));
            end = period + std::min(1.0, static_cast<double>(i + 1) / across);
        }
        // A stretch shorter than the rounding of coordinates belongs to the next pixel.
        constexpr double rounding = 1e-12;  // derived from the rounding of double precision
        end = std::min(to, std::max(end, t + rounding * std::max(1.0, std::abs(t))));
        out.emplace_back(i, (end - t) / length);
        t = end;
    }
    return out;
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
    const auto by = static_cast<double>(factor);
    out.levels_.push_back(
        {halved(pixels.width, factor), halved(pixels.height, factor), static_cast<double>(pixels.width) / by,
         static_cast<double>(pixels.height) / by,
         means_of_blocks(pixels.width, pixels.height, factor, [&](std::size_t x, std::size_t y, std::size_t c) {
             return 65535 * decode.value[pixels.rgb[3 * (y * pixels.width + x) + c]];
         })});
    while (std::max(out.levels_.back().width, out.levels_.back().height) > 1) {
        const Level& fine = out.levels_.back();
        Level half{halved(fine.width, 2), halved(fine.height, 2), 0.5 * fine.across, 0.5 * fine.down,
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
    const double wanted = std::clamp(std::log2(std::max(1.0, size)), 0.0, static_cast<double>(levels_.size() - 1));
    const Level& level = levels_[static_cast<std::size_t>(std::lround(wanted))];
    const double width = level.across, height = level.down;
    const double u = place.x * width - 0.5, i = std::floor(u), v = place.y * height - 0.5, j = std::floor(v);
    Colour sum{};
    for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a) {
            const double weight = (a == 0 ? i + 1 - u : u - i) * (b == 0 ? j + 1 - v : v - j);
            const Colour here =
                level.at(pixel((i + a + 0.5) / width, width, wrap_s), pixel((j + b + 0.5) / height, height, wrap_t));
            for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * here[c];
        }
    return sum;
}

/// The coarsest level whose pixels are not wider than `step` in either direction: coarser pixels would include light
/// from outside the face.
const TextureArea::Level& TextureArea::level_for(const Vec2& step) const {
    const Level& finest = levels_.front();
    const double pixels = std::min(step.x * finest.across, step.y * finest.down);
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
            sum.add(level.at(pixel(x, level.across, wrap_s), pixel(y, level.down, wrap_t)));
        }
    }
    if (sum.count() == 0)
        return even_part(level.at(pixel(middle.x, level.across, wrap_s), pixel(middle.y, level.down, wrap_t)));
    return sum.part();
}

std::vector<double> TextureArea::borders(bool along_s, double low, double high, std::size_t max_cells) const {
    const double across = along_s ? levels_.front().across : levels_.front().down;
    double block = 1;  // pixels
    while ((high - low) * across / block > static_cast<double>(max_cells) && block < across) block *= 2;
    double periods = 1;  // number of repetitions in a cell, if a cell contains whole ones
    while ((high - low) / periods > static_cast<double>(max_cells)) periods *= 2;
    // A cell narrower than this share of the whole would be a sliver without effect.
    constexpr double min_share = 1e-3;  // share of the whole; derived from the narrowest face that rays hit
    const double margin = min_share * (high - low);
    std::vector<double> out = {low};
    const auto add = [&](double place) {
        if (place > out.back() + 0.5 * margin && place > low + margin && place < high - margin) out.push_back(place);
    };
    for (double period = std::floor(low / periods) * periods; period < high; period += periods) {
        add(period);
        if (periods > 1 || block >= across) continue;
        const double first = std::max(0.0, std::floor((low - period) * across / block));
        for (double i = first; i * block < across && period + i * block / across < high; ++i)
            add(period + i * block / across);
    }
    out.push_back(high);
    return out;
}

std::vector<TextureArea::Colour> TextureArea::cell_means(std::span<const double> columns, std::span<const double> rows,
                                                         Wrap wrap_s, Wrap wrap_t) const {
    const std::size_t nx = columns.size() - 1, ny = rows.size() - 1;
    const Level& level = level_for({(columns.back() - columns.front()) / static_cast<double>(nx),
                                    (rows.back() - rows.front()) / static_cast<double>(ny)});
    std::vector<PixelShares> shares(nx);
    std::vector<std::uint8_t> is_used(level.width);
    for (std::size_t i = 0; i < nx; ++i) {
        shares[i] = shares_of(columns[i], columns[i + 1], level.across, wrap_s);
        for (const auto& [x, share] : shares[i]) is_used[x] = 1;
    }
    std::vector<Colour> out, row(level.width);
    out.reserve(nx * ny);
    for (std::size_t j = 0; j < ny; ++j) {
        std::fill(row.begin(), row.end(), Colour{});
        for (const auto& [y, share] : shares_of(rows[j], rows[j + 1], level.down, wrap_t))
            for (std::size_t x = 0; x < level.width; ++x) {
                if (!is_used[x]) continue;
                const Colour c = level.at(x, y);
                for (std::size_t k = 0; k < 3; ++k) row[x][k] += share * c[k];
            }
        for (std::size_t i = 0; i < nx; ++i) {
            Colour& mean = out.emplace_back();
            for (const auto& [x, share] : shares[i])
                for (std::size_t k = 0; k < 3; ++k) mean[k] += share * row[x][k];
        }
    }
    return out;
}

}  // namespace exitance

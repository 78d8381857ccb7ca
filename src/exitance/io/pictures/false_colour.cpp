#include "exitance/io/pictures/false_colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

constexpr Rgb white{255, 255, 255}, night{20, 20, 24}, back_of_surface{58, 58, 62};

using Anchors = std::array<Rgb, 9>;

/// Nine colours of each palette, between which sRGB values are interpolated: viridis and inferno (Smith and van der
/// Walt, 2015), turbo (Mikhailov, 2019).
const Anchors& anchors_of(Palette palette) {
    static constexpr Anchors viridis{{{68, 1, 84},
                                      {71, 44, 122},
                                      {59, 81, 139},
                                      {44, 113, 142},
                                      {33, 144, 141},
                                      {39, 173, 129},
                                      {92, 200, 99},
                                      {170, 220, 50},
                                      {253, 231, 37}}};
    static constexpr Anchors inferno{{{0, 0, 4},
                                      {31, 12, 72},
                                      {85, 15, 109},
                                      {136, 34, 106},
                                      {186, 54, 85},
                                      {227, 89, 51},
                                      {249, 140, 10},
                                      {249, 201, 50},
                                      {252, 255, 164}}};
    static constexpr Anchors turbo{{{48, 18, 59},
                                    {70, 107, 227},
                                    {40, 187, 236},
                                    {49, 242, 153},
                                    {162, 252, 60},
                                    {237, 208, 58},
                                    {251, 128, 34},
                                    {210, 49, 5},
                                    {122, 4, 3}}};
    static constexpr Anchors grey{{{16, 16, 16},
                                   {46, 46, 46},
                                   {76, 76, 76},
                                   {106, 106, 106},
                                   {136, 136, 136},
                                   {166, 166, 166},
                                   {196, 196, 196},
                                   {226, 226, 226},
                                   {255, 255, 255}}};
    switch (palette) {
        case Palette::inferno:
            return inferno;
        case Palette::turbo:
            return turbo;
        case Palette::grey:
            return grey;
        case Palette::viridis:
            break;
    }
    return viridis;
}

/// Colour of a palette at t in [0, 1].
Rgb colour_at(Palette palette, double t) {
    const Anchors& anchors = anchors_of(palette);
    const double at = std::clamp(t, 0.0, 1.0) * (anchors.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
    const double between = at - static_cast<double>(i);
    Rgb colour;
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = static_cast<std::uint8_t>(std::lround(std::lerp(anchors[i][c], anchors[i + 1][c], between)));
    return colour;
}

Rgb band_colour(const ColourScale& scale, std::size_t band) {
    const std::size_t count = scale.band_count();
    return colour_at(scale.palette, count > 1 ? static_cast<double>(band) / static_cast<double>(count - 1) : 0.5);
}

/// Limits of `count` bands of equal width or equal ratio.
std::vector<double> even_steps(double lo, double hi, bool by_ratio, std::size_t count) {
    std::vector<double> steps;
    for (std::size_t k = 0; k <= count; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(count);
        steps.push_back(by_ratio ? lo * std::pow(hi / lo, t) : std::lerp(lo, hi, t));
    }
    return steps;
}

std::vector<double> linear_steps(double lo, double hi) {
    constexpr double wanted = 9;
    const double raw = (hi - lo) / wanted, power = std::pow(10, std::floor(std::log10(raw)));
    const double factor = raw / power;
    const double step = power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
    std::vector<double> steps;
    const double first = std::floor(lo / step), last = std::ceil(hi / step);
    for (double k = first; k <= std::max(last, first + 1); ++k) steps.push_back(k * step);
    return steps;
}

std::vector<double> steps_by_ratio(double lo, double hi) {
    std::vector<double> steps;
    const int first = static_cast<int>(std::floor(std::log10(lo))), last = static_cast<int>(std::ceil(std::log10(hi)));
    for (int k = first; k <= last; ++k)
        for (const double digit : {1.0, 2.0, 5.0}) steps.push_back(digit * std::pow(10, k));
    while (steps.size() > 2 && steps[1] <= lo) steps.erase(steps.begin());
    while (steps.size() > 2 && steps[steps.size() - 2] >= hi) steps.pop_back();
    return steps;
}

/// Round steps that include the range.
std::vector<double> round_steps(double lo, double hi, bool by_ratio) {
    return by_ratio ? steps_by_ratio(lo, hi) : linear_steps(lo, hi);
}

/// Round steps inside a range, plus its ends.
std::vector<double> steps_within(double lo, double hi, bool by_ratio) {
    std::vector<double> steps = round_steps(lo, hi, by_ratio);
    const double near = 1e-6 * (hi - lo);
    std::erase_if(steps, [&](double step) { return step <= lo + near || step >= hi - near; });
    steps.insert(steps.begin(), lo), steps.push_back(hi);
    return steps;
}

}  // namespace

std::string title(Quantity quantity, bool photometric) {
    switch (quantity) {
        case Quantity::radiosity:
            return photometric ? "exitance lm/m^2" : "radiosity W/m^2";
        case Quantity::irradiance:
            return photometric ? "illuminance lx" : "irradiance W/m^2";
        case Quantity::luminance:
            return photometric ? "luminance cd/m^2" : "luminance W/m^2/sr";
        case Quantity::illuminance:
            return photometric ? "illuminance lx" : "weighted irradiance W/m^2";
    }
    return "";
}

double value_of(const Pixel& pixel, Quantity quantity) {
    switch (quantity) {
        case Quantity::radiosity:
            return mean(pixel.radiosity);
        case Quantity::irradiance:
            return mean(pixel.irradiance);
        case Quantity::luminance:
            return luminous_sum(radiance_of_exitance(pixel.radiosity));
        case Quantity::illuminance:
            return luminous_sum(pixel.irradiance);
    }
    return 0;
}

std::vector<std::string> ColourScale::names() const {
    std::vector<std::string> out;
    for (const double step : steps) out.push_back(fmt::format("{:.6g}", step));
    return out;
}

std::size_t ColourScale::band(double value) const {
    const auto above = std::upper_bound(steps.begin() + 1, steps.end() - 1, value);
    return static_cast<std::size_t>(above - steps.begin()) - 1;
}

double ColourScale::place(double value) const {
    const std::size_t i = band(value);
    const double within = std::clamp((value - steps[i]) / (steps[i + 1] - steps[i]), 0.0, 1.0);
    return (static_cast<double>(i) + within) / static_cast<double>(band_count());
}

Rgb ColourScale::colour(double value) const {
    return smooth ? colour_at(palette, place(value)) : band_colour(*this, band(value));
}

namespace {

/// Range of values for the scale of a picture; empty if nothing is lit.
std::optional<std::pair<double, double>> range_of(const Picture& picture, Quantity quantity) {
    std::vector<double> values;
    for (const Pixel& pixel : picture.pixels)
        if (pixel.front > 0 && !pixel.emits()) values.push_back(value_of(pixel, quantity));
    if (values.empty())
        for (const Pixel& pixel : picture.pixels)
            if (pixel.front > 0) values.push_back(value_of(pixel, quantity));
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const double lo = values[values.size() / 100], hi = values[values.size() - 1 - values.size() / 100];
    if (!(hi > 0)) return {};
    return std::pair(lo, hi);
}

}  // namespace

ColourScale make_colour_scale(const Picture& picture, Quantity quantity, const ScaleChoice& choice) {
    ColourScale scale{{0, 1}, choice.palette, choice.smooth};
    const auto range = choice.range ? choice.range : range_of(picture, quantity);
    if (!range) return scale;
    auto [lo, hi] = *range;
    constexpr double min_range_for_log = 30, min_ratio = 1e-4;  // values below this share of the maximum count as dark
    const bool by_ratio = choice.by_ratio || (!choice.range && hi > min_range_for_log * lo);
    if (by_ratio) lo = std::max(lo, min_ratio * hi);
    if (!choice.range && !by_ratio) lo = std::min(lo, 0.98 * hi);
    scale.steps = choice.range ? steps_within(lo, hi, by_ratio) : round_steps(lo, hi, by_ratio);
    if (choice.bands)
        scale.steps =
            even_steps(scale.steps.front(), scale.steps.back(), by_ratio && scale.steps.front() > 0, *choice.bands);
    return scale;
}

namespace {

/// Smallest change of the value to the pixels on either side of a pixel: edges of surfaces, where the value jumps on
/// one side, do not count. `next` is the distance of those pixels in the picture's array.
double change_along(std::span<const double> values, std::size_t i, std::size_t at, std::size_t count,
                    std::size_t next) {
    if (at == 0 || at + 1 == count) return 0;
    return std::min(std::abs(values[i] - values[i - next]), std::abs(values[i + next] - values[i]));
}

/// Mean colour of the values from value - change / 2 to value + change / 2, which a pixel shows where light changes by
/// that much from pixel to pixel. Without it, borders between the colours would have steps.
std::array<double, 3> mean_colour(const ColourScale& scale, double value, double change) {
    constexpr int samples = 8;
    std::array<double, 3> sum{};
    for (int k = 0; k < samples; ++k) {
        const Rgb colour = scale.colour(value + change * ((k + 0.5) / samples - 0.5));
        for (std::size_t c = 0; c < 3; ++c) sum[c] += colour[c] / static_cast<double>(samples);
    }
    return sum;
}

}  // namespace

Image false_colour_image(const Picture& picture, Quantity quantity, const ColourScale& scale) {
    Image image(picture.size.width, picture.size.height);
    const auto width = static_cast<std::size_t>(picture.size.width),
               height = static_cast<std::size_t>(picture.size.height);
    std::vector<double> values;
    for (const Pixel& pixel : picture.pixels) values.push_back(value_of(pixel, quantity));
    std::uint8_t* out = image.rgb.data();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Pixel& pixel = picture.pixels[i];
        const double change =
            change_along(values, i, i % width, width, 1) + change_along(values, i, i / width, height, width);
        const std::array<double, 3> front = mean_colour(scale, values[i], change);
        const double rest = 1 - pixel.front - pixel.back;
        for (std::size_t c = 0; c < 3; ++c)
            *out++ = static_cast<std::uint8_t>(
                std::lround(pixel.front * front[c] + pixel.back * back_of_surface[c] + rest * night[c]));
    }
    return image;
}

/// Draws a column of colours, darkest at the bottom, with the value of each border, and the title in two lines above.
void draw_legend(Image& image, const std::string& text, const ColourScale& scale) {
    const int s = std::max(1, std::min(image.width / 600, image.height / 375)), size = 11 * s;
    const std::size_t gap = text.find(' ');
    const std::vector<std::string> names = scale.names();
    int widest = std::max(text_width(text.substr(0, gap), size), text_width(text.substr(gap + 1), size));
    for (const std::string& name : names) widest = std::max(widest, 17 * s + text_width(name, size));
    const int count = static_cast<int>(scale.band_count()), margin = 7 * s;
    const int band = std::clamp((image.height - 52 * s) / (count + 1), 4, 18 * s);
    const int width = widest + 2 * margin, height = 50 * s + band * count;
    const int left = image.width - width - margin, top = margin;
    fill_rectangle(image, left, top, width, height, night);
    draw_text(image, left + margin, top + margin, text.substr(0, gap), size, white);
    draw_text(image, left + margin, top + margin + 14 * s, text.substr(gap + 1), size, white);
    const int bottom = top + 38 * s + band * count;
    for (int y = 0; y < band * count; ++y) {
        const double place = (y + 0.5) / (band * count);
        const Rgb colour =
            scale.smooth ? colour_at(scale.palette, place) : band_colour(scale, static_cast<std::size_t>(y / band));
        fill_rectangle(image, left + margin, bottom - y - 1, 12 * s, 1, colour);
    }
    const int every = band < 12 * s ? (12 * s + band - 1) / band : 1;  // keeps labels from overlapping
    for (int i = 0; i <= count; i += every)
        draw_text(image, left + margin + 17 * s, bottom - band * i - 4 * s, names[static_cast<std::size_t>(i)], size,
                  white);
}

}  // namespace exitance

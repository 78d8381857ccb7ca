#include "exitance/io/pictures/false_colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/pictures/bitmap_font.hpp"

namespace exitance {
namespace {

constexpr Rgb white{255, 255, 255}, night{20, 20, 24}, back_of_surface{58, 58, 62};

/// Nine of the colours of viridis (Smith and van der Walt, 2015), between which sRGB values are interpolated.
Rgb viridis(double t) {
    constexpr std::array<Rgb, 9> anchors{{{68, 1, 84},
                                          {71, 44, 122},
                                          {59, 81, 139},
                                          {44, 113, 142},
                                          {33, 144, 141},
                                          {39, 173, 129},
                                          {92, 200, 99},
                                          {170, 220, 50},
                                          {253, 231, 37}}};
    const double at = std::clamp(t, 0.0, 1.0) * (anchors.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
    const double between = at - static_cast<double>(i);
    Rgb colour;
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = static_cast<std::uint8_t>(std::lround(std::lerp(anchors[i][c], anchors[i + 1][c], between)));
    return colour;
}

Rgb band_colour(std::size_t band, std::size_t count) {
    return viridis(count > 1 ? static_cast<double>(band) / static_cast<double>(count - 1) : 0.5);
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

std::string title(Quantity quantity) {
    switch (quantity) {
        case Quantity::radiosity:
            return "radiosity W/m^2";
        case Quantity::irradiance:
            return "irradiance W/m^2";
        case Quantity::luminance:
            return "luminance cd/m^2";
        case Quantity::illuminance:
            return "illuminance lx";
    }
    return "";
}

}  // namespace

double luminous_mean(const Spectrum& s) {
    if constexpr (bands == 3) return 0.2126 * s[0] + 0.7152 * s[1] + 0.0722 * s[2];
    return mean(s);
}

double value_of(const Pixel& pixel, Quantity quantity) {
    switch (quantity) {
        case Quantity::radiosity:
            return mean(pixel.radiosity);
        case Quantity::irradiance:
            return mean(pixel.irradiance);
        case Quantity::luminance:
            return luminous_mean(radiance_of_exitance(pixel.radiosity));
        case Quantity::illuminance:
            return luminous_mean(pixel.irradiance);
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

ColourScale make_colour_scale(const Picture& picture, Quantity quantity) {
    std::vector<double> values;
    for (const Pixel& pixel : picture.pixels)
        if (pixel.front > 0 && !pixel.emits()) values.push_back(value_of(pixel, quantity));
    if (values.empty())
        for (const Pixel& pixel : picture.pixels)
            if (pixel.front > 0) values.push_back(value_of(pixel, quantity));
    if (values.empty()) return {{0, 1}};
    std::sort(values.begin(), values.end());
    const double lo = values[values.size() / 100], hi = values[values.size() - 1 - values.size() / 100];
    if (!(hi > 0)) return {{0, 1}};
    constexpr double least_ratio = 1e-4;  // below this share of the brightest all is dark
    if (hi > 30 * lo) return {steps_by_ratio(std::max(lo, least_ratio * hi), hi)};
    return {linear_steps(std::min(lo, 0.98 * hi), hi)};
}

Image false_colour_image(const Picture& picture, Quantity quantity, const ColourScale& scale) {
    Image image(picture.size.width, picture.size.height);
    std::uint8_t* out = image.rgb.data();
    for (const Pixel& pixel : picture.pixels) {
        const Rgb front = band_colour(scale.band(value_of(pixel, quantity)), scale.band_count());
        const double rest = 1 - pixel.front - pixel.back;
        for (std::size_t c = 0; c < 3; ++c)
            *out++ = static_cast<std::uint8_t>(
                std::lround(pixel.front * front[c] + pixel.back * back_of_surface[c] + rest * night[c]));
    }
    return image;
}

/// A column of colours, darkest at the bottom, each border with its value; the title in two lines above.
void draw_legend(Image& image, Quantity quantity, const ColourScale& scale) {
    const int s = std::max(1, std::min(image.width / 600, image.height / 375));
    const std::string text = title(quantity);
    const std::size_t gap = text.find(' ');
    const std::vector<std::string> names = scale.names();
    int widest = std::max(text_width(text.substr(0, gap), s), text_width(text.substr(gap + 1), s));
    for (const std::string& name : names) widest = std::max(widest, 16 * s + text_width(name, s));
    const int count = static_cast<int>(scale.band_count()), margin = 6 * s;
    const int band = std::clamp((image.height - 40 * s) / (count + 1), 4, 18 * s);
    const int width = widest + 2 * margin, height = 38 * s + band * count;
    const int left = image.width - width - margin, top = margin;
    fill_rectangle(image, left, top, width, height, night);
    draw_text(image, left + margin, top + 5 * s, text.substr(0, gap), s, white);
    draw_text(image, left + margin, top + 15 * s, text.substr(gap + 1), s, white);
    const int bottom = top + 30 * s + band * count;
    for (int i = 0; i < count; ++i)
        fill_rectangle(image, left + margin, bottom - band * (i + 1), 11 * s, band,
                       band_colour(static_cast<std::size_t>(i), scale.band_count()));
    const int every = band < 9 * s ? (9 * s + band - 1) / band : 1;  // names must not touch
    for (int i = 0; i <= count; i += every)
        draw_text(image, left + margin + 16 * s, bottom - band * i - 3 * s, names[static_cast<std::size_t>(i)], s,
                  white);
}

}  // namespace exitance

#include "exitance/scene/material_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace exitance {

int srgb_code(double linear) {
    const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255 * std::clamp(v, 0.0, 16.0)));
}

std::string name_with_colour(std::string_view material, const Spectrum& colour) {
    const auto channel = [&](std::size_t k) { return std::clamp(srgb_code(colour[k * bands / 3]), 0, 255); };
    return fmt::format("{} #{:02x}{:02x}{:02x}", material, channel(0), channel(1), channel(2));
}

std::string_view name_in_file(std::string_view material) {
    constexpr std::size_t colour = 8;  // length of " #rrggbb"
    if (material.size() < colour) return material;
    const std::string_view end = material.substr(material.size() - colour);
    const bool is_colour = end.starts_with(" #") && end.find_first_not_of("0123456789abcdef", 2) == end.npos;
    return is_colour ? material.substr(0, material.size() - colour) : material;
}

}  // namespace exitance

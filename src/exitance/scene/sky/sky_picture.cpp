#include "exitance/scene/sky/sky_picture.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/check.hpp"

namespace exitance {

SkyPicture::SkyPicture(std::vector<double> values) : values_(std::move(values)) {
    EXI_CHECK(values_.size() == size);
}

double SkyPicture::value(const Vec3& w, bool is_below) const {
    constexpr double half = rows / 2;
    const double altitude = std::asin(std::clamp(w.z, -1.0, 1.0)), turn = std::atan2(w.y, w.x) / (2 * pi);
    // The position in units of cells; the middles of cells are at whole numbers.
    const double first = is_below ? 0 : half;
    const double y = std::clamp(half + altitude / cell_angle - 0.5, first, first + half - 1);
    const double x = (turn < 0 ? turn + 1 : turn) * columns + columns - 0.5;
    const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(x);
    const double up = y - static_cast<double>(row), along = x - static_cast<double>(column);
    const std::size_t last_row = static_cast<std::size_t>(first + half) - 1;
    const auto across = [&](std::size_t r) {
        const double* const at = &values_[r * columns];
        return (1 - along) * at[column % columns] + along * at[(column + 1) % columns];
    };
    return (1 - up) * across(row) + up * across(std::min(row + 1, last_row));
}

double SkyPicture::horizontal_mean(bool is_below) const {
    constexpr std::size_t parts = 4;  // points per side of a cell
    constexpr std::size_t count = parts * rows / 2;
    const double step = 0.5 * pi / count;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double low = static_cast<double>(i) * step, middle = low + 0.5 * step;
        // The integral of 2 sin cos over the strip.
        const double weight = std::pow(std::sin(low + step), 2) - std::pow(std::sin(low), 2);
        double row = 0;
        for (std::size_t k = 0; k < parts * columns; ++k) {
            const double angle = 2 * pi * (static_cast<double>(k) + 0.5) / (parts * columns);
            row += value({std::cos(middle) * std::cos(angle), std::cos(middle) * std::sin(angle),
                          is_below ? -std::sin(middle) : std::sin(middle)},
                         is_below);
        }
        sum += weight * row / (parts * columns);
    }
    return sum;
}

bool SkyPicture::are_sane(std::span<const double> values) {
    constexpr double largest = 1e30;  // equal to the limit for other light in files
    return std::all_of(values.begin(), values.end(), [](double v) { return v >= 0 && v <= largest; });
}

}  // namespace exitance

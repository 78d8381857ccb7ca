#include "exitance/base/direction_order.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr std::uint32_t bits = 5;  ///< Bits per coordinate: 1024 cells, of about 6 degrees.

std::uint32_t spread(std::uint32_t v) {
    v = (v | v << 4) & 0x0f0fu;
    v = (v | v << 2) & 0x3333u;
    return (v | v << 1) & 0x5555u;
}

/// Cell of a direction on the octahedron |x| + |y| + |z| = 1, unfolded to a square.
std::uint16_t cell_of(const Vec3& w) {
    const double sum = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
    double u = w.x / sum, v = w.y / sum;
    if (w.z < 0) {
        const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
        v = (1 - std::abs(u)) * (v < 0 ? -1 : 1), u = folded;
    }
    constexpr double columns = 1u << bits;
    const auto column = [](double t) {
        const double at = 0.5 * (t + 1) * columns;
        return at > 0 ? static_cast<std::uint32_t>(std::min(at, columns - 1)) : 0u;  // also 0 for NaN
    };
    return static_cast<std::uint16_t>(spread(column(u)) | spread(column(v)) << 1);
}

}  // namespace

std::span<const std::uint32_t> DirectionOrder::sort(std::span<const Vec3> directions) {
    cell_.resize(directions.size()), order_.resize(directions.size());
    first_.assign((1u << 2 * bits) + 1, 0);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        cell_[i] = cell_of(directions[i]);
        ++first_[cell_[i] + 1u];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    for (std::size_t i = 0; i < directions.size(); ++i) order_[first_[cell_[i]]++] = static_cast<std::uint32_t>(i);
    return order_;
}

}  // namespace exitance

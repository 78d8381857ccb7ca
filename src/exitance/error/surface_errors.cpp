#include "exitance/error/surface_errors.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr std::size_t min_points = 8;  ///< Student's 95% limit is then within 2.4 standard errors.

}  // namespace

std::vector<FaceError> surface_errors(std::span<const PointError> points, std::span<const double> of_rooms) {
    const std::size_t count = of_rooms.size();
    std::vector<std::size_t> looked(count);
    std::vector<double> weight(count), sum(count), spread(count);
    for (const PointError& p : points) {
        const std::size_t s = p.surface.value;
        ++looked[s], weight[s] += p.weight, sum[s] += p.weight * p.squared;
    }
    for (const PointError& p : points) {
        const std::size_t s = p.surface.value;
        const double off = p.weight * (p.squared - sum[s] / weight[s]);
        spread[s] += off * off;
    }
    std::vector<FaceError> out;
    for (std::size_t s = 0; s < count; ++s) {
        if (looked[s] < min_points || weight[s] <= 0) {
            out.push_back({of_rooms[s], 0});
            continue;
        }
        // The reported error is at least its own standard error.
        const double n = static_cast<double>(looked[s]);
        const double mean = sum[s] / weight[s], standard_error = std::sqrt(spread[s] * n / (n - 1)) / weight[s];
        out.push_back({std::sqrt(std::max(mean, standard_error)), looked[s]});
    }
    return out;
}

}  // namespace exitance

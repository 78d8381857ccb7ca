#include "exitance/base/error_share.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {

double fewer_rays_in_crowd(std::size_t elements) {
    constexpr double least = 0.25;  // derived from the fewest rays of a row, 4
    const double most = static_cast<double>(ErrorShare::max_even_count), count = static_cast<double>(elements);
    return count > most ? std::max(least, std::sqrt(most / count)) : 1;
}

double share_of_crowd(std::vector<double> errors, double bound) {
    if (errors.empty()) return bound;
    std::sort(errors.begin(), errors.end());
    double below = 0, share = HUGE_VAL;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const double left = static_cast<double>(errors.size() - i);
        if (below + left * errors[i] > 0.5 * bound) {
            share = (0.5 * bound - below) / left;
            break;
        }
        below += errors[i];
    }
    const double even = bound / static_cast<double>(errors.size());
    return std::clamp(share, even, std::max(even, bound / static_cast<double>(ErrorShare::min_count)));
}

double even_noise_area(std::span<const double> areas) {
    double sum = 0, roots = 0;
    for (const double area : areas) sum += area, roots += std::sqrt(area);
    return roots > 0 ? (sum / roots) * (sum / roots) : 0;
}

}  // namespace exitance

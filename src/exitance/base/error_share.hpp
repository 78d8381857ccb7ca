#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace exitance {

/// Divides a bound on the sum of squared errors among elements, for scenes in which most elements are whole small
/// polygons: leaves, slats, thin triangles. An even share, bound / elements, falls with their number, although each of
/// them has almost no error, and would refine the walls around them without end. Here the unused part of the small
/// elements' shares goes to the others.
struct ErrorShare {
    /// Up to `most_even` elements, shares are even. Above it, no element gets more than 1 / `least_count` of the bound.
    static constexpr std::size_t most_even = 4000, least_count = 1000;

    /// True if there are more than `most_even` elements and most of them are whole polygons.
    static bool is_crowd(std::size_t elements, std::size_t polygons) {
        return elements > most_even && 2 * polygons > elements;
    }
};

/// Returns the largest share s with  sum min(error_i, s) <= bound / 2,  clamped to between bound / (number of errors)
/// and bound / `least_count`. Elements with a larger error are to be split; the other half of the bound is for the
/// error of their children. Errors must not be negative. O(n log n).
double share_of_crowd(std::vector<double> errors, double bound);

/// Returns the area m for which the noise e_i^2 = e^2 sqrt(m / area_i), the allocation that needs fewest rays, has the
/// area-weighted mean e^2:  m = (sum area / sum sqrt(area))^2, m^2. It is the mean area if all areas are equal, else
/// more.
double even_noise_area(std::span<const double> areas);

}  // namespace exitance

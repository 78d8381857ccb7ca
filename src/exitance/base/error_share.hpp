#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace exitance {

/// Divides a bound on the sum of squared errors among elements, for scenes in which most elements are whole small
/// polygons: leaves, slats, thin triangles. If every element got bound / elements, the shares would be small because
/// there are many elements, although most of these have almost no error. The walls around them would then be refined
/// without end. Here the unused part of the small elements' shares goes to the others.
struct ErrorShare {
    /// Up to `max_even_count` elements, shares are even. Above it, no element gets more than 1 / `min_count` of the
    /// bound.
    static constexpr std::size_t max_even_count = 4000, min_count = 1000;

    /// True if there are more than `max_even_count` elements and most of them are whole polygons. `multiplicity`:
    /// factor on the limit (`LightRooms::multiplicity`).
    static bool is_crowd(std::size_t elements, std::size_t polygons, double multiplicity = 1) {
        return static_cast<double>(elements) > multiplicity * max_even_count && 2 * polygons > elements;
    }

    /// Area below which a single element of a crowd hardly contributes to the error. It is `far_from_mean` times the
    /// mean area, but no more than 1 / (`multiplicity` `max_even_count`) of the area of all elements, `area`, and at
    /// least the mean area.
    static double small_area(double area, std::size_t elements, double multiplicity = 1) {
        constexpr double far_from_mean = 8;  // derived from meshes of even triangles: all are below it
        const double mean = area / static_cast<double>(elements);
        return std::clamp(far_from_mean * mean, mean, std::max(mean, area / (multiplicity * max_even_count)));
    }
};

/// Returns the factor on the rays of an element whose noise counts only in sums over many elements: 1 up to
/// `ErrorShare::max_even_count` elements, above it less, but at least a quarter.
double fewer_rays_in_crowd(std::size_t elements);

/// Returns the largest share s with  sum min(error_i, s) <= bound / 2,  clamped to between bound / (number of errors)
/// and bound / `min_count`. Elements with a larger error are to be split; the other half of the bound is for the
/// error of their children. Errors must not be negative. O(n log n).
double share_of_crowd(std::vector<double> errors, double bound);

/// Returns the area m for which the noise e_i^2 = e^2 sqrt(m / area_i), the allocation that needs fewest rays, has the
/// area-weighted mean e^2:  m = (sum area / sum sqrt(area))^2, m^2. It is the mean area if all areas are equal, else
/// more.
double even_noise_area(std::span<const double> areas);

}  // namespace exitance

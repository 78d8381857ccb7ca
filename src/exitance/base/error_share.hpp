#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace exitance {

/// How a bound on the sum of squared errors of elements is dealt out where most elements are whole polygons of the
/// scene that nobody wanted so small: leaves, slats, thin triangles. An even share, bound / elements, is less the more
/// of them there are, although each errs by next to nothing; walls beside them would be cut for it without end. What
/// small ones leave over is for the others.
struct ErrorShare {
    /// Below so many elements shares are even; those of a crowd are those of so many at most.
    static constexpr std::size_t most_even = 4000, least_count = 1000;

    /// Are most of many elements whole polygons?
    static bool is_crowd(std::size_t elements, std::size_t polygons) {
        return elements > most_even && 2 * polygons > elements;
    }
};

/// The largest share s with  sum min(error_i, s) <= bound / 2,  but between bound / (number of errors) and bound /
/// `least_count`: then elements with a larger error are to be cut. The other half of the bound is for what their pieces
/// keep. Errors are not negative; O(n log n).
double share_of_crowd(std::vector<double> errors, double bound);

/// The area m for which errors e_i^2 = e^2 sqrt(m / area_i), as rays for them cost least, are e^2 in the mean over all
/// areas:  m = (sum area / sum sqrt(area))^2,  the mean area where all are alike, else more. m^2
double even_noise_area(std::span<const double> areas);

}  // namespace exitance

#pragma once

#include <cstddef>

namespace exitance {

/// An estimated error and its standard error.
struct UncertainError {
    double estimate = 0, standard_error = 0;
};

/// Returns how many times as many points an error must be measured at again, 0 to 3, so that it can be compared with a
/// limit. The error is measured again in two cases: if the estimate is above `limit` by at most two standard errors,
/// and if it is below `limit` but its upper confidence limit (`student_95` standard errors more) is above the requested
/// error `demand`, which happens if a few points have most of the error. Measuring again is cheaper than another
/// attempt.
std::size_t further_measurements(const UncertainError& error, double limit, double demand);

}  // namespace exitance

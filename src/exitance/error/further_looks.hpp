#pragma once

#include <cstddef>

namespace exitance {

/// An estimated error and its standard error.
struct UncertainError {
    double estimate = 0, standard_error = 0;
};

/// Returns how many times as many points an error must be measured at again, 0 to 3, so that it can be compared with a
/// limit. A clear error needs none. Others are an estimate that is at most two standard errors above `limit`, and one
/// below it that is less than a standard error below the requested error `demand`, as if a few points have most of the
/// error. Measuring again is cheaper than another attempt.
std::size_t further_looks(const UncertainError& error, double limit, double demand);

}  // namespace exitance

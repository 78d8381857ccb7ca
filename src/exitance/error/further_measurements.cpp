#include "exitance/error/further_measurements.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/error/batch_mean.hpp"

namespace exitance {

std::size_t further_measurements(const UncertainError& error, double limit, double demand) {
    constexpr double sufficient = 2;  // required distance between an estimate and its limit, in standard errors
    constexpr double max_factor = 4;  // limit, as a multiple of the points; it halves the standard error
    const bool is_above = error.estimate > limit;
    const double distance = is_above ? error.estimate - limit : demand - error.estimate;
    if (error.standard_error * (is_above ? sufficient : student_95) <= distance) return 0;
    // The standard error decreases with the root of the number of points.
    const double factor = distance > 0 ? std::pow(sufficient * error.standard_error / distance, 2) : max_factor;
    return static_cast<std::size_t>(std::ceil(std::clamp(factor, 2.0, max_factor))) - 1;
}

}  // namespace exitance

#include "exitance/what_if/daylight/spread_result.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Student's factor for 95% and 7 degrees of freedom: one fewer than replicates.
constexpr double student = 2.3646;
static_assert(daylight_replicates == 8);

}  // namespace

Interval SpreadResult::interval() const {
    const ReplicateMean found = mean_of(replicates);
    const double noise = student * std::sqrt(found.variance);
    const double below = value - std::min(less, more), above = std::max(less, more) - value;
    return {value - std::hypot(noise, std::max(0.0, below)), value + std::hypot(noise, std::max(0.0, above))};
}

Interval share_interval(const SpreadResult& counts, double sensors) {
    SpreadResult shares;
    for_each_value(shares, counts, [&](double& share, double count) { share = count / sensors; });
    const Interval bounds = shares.interval();
    return {std::max(0.0, bounds.low), std::min(1.0, bounds.high)};
}

}  // namespace exitance

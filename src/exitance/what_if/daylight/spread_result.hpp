#pragma once

#include "exitance/what_if/daylight/daylight_error.hpp"

namespace exitance {

/// Bounds of a result.
struct Interval {
    double low = 0, high = 0;
};

/// A result: `value` follows from the mean of the replicates, `less` and `more` from that mean less and plus the bias.
struct SpreadResult {
    double value = 0, less = 0, more = 0;
    Replicates replicates{};

    /// 95% interval: Student's for the mean of the replicates, widened to the results with less and more light.
    Interval interval() const;
};

/// Calls f(sum, value) for every value of a spread result.
template <class F>
void for_each_value(SpreadResult& sum, const SpreadResult& value, const F& f) {
    f(sum.value, value.value), f(sum.less, value.less), f(sum.more, value.more);
    for (std::size_t k = 0; k < daylight_replicates; ++k) f(sum.replicates[k], value.replicates[k]);
}

/// Returns the interval of the share of `sensors` that reach a value, from the number of those that do.
Interval share_interval(const SpreadResult& counts, double sensors);

}  // namespace exitance

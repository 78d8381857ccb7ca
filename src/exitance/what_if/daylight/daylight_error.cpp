#include "exitance/what_if/daylight/daylight_error.hpp"

#include <cmath>

namespace exitance {

DaylightError worst_of(std::span<const DaylightError> errors) {
    DaylightError out;
    const auto larger = [](double a, double b) { return std::isnan(a) || a >= b ? a : b; };
    for (const DaylightError& e : errors) out = {larger(out.factor, e.factor), larger(out.lux_hours, e.lux_hours)};
    return out;
}

ReplicateMean mean_of(const Replicates& values) {
    constexpr auto n = static_cast<double>(daylight_replicates);
    ReplicateMean out;
    for (const double v : values) out.mean += v / n;
    for (const double v : values) out.variance += (v - out.mean) * (v - out.mean) / (n * (n - 1));
    return out;
}

void GridErrorSum::add(const LinearResults& sensor) {
    const ReplicateMean factor = mean_of(sensor.factor), lux_hours = mean_of(sensor.lux_hours);
    factor_.mean += factor.mean, factor_.variance += factor.variance;
    lux_hours_.mean += lux_hours.mean, lux_hours_.variance += lux_hours.variance;
    ++count_;
}

DaylightError GridErrorSum::error(const DaylightBias& bias) const {
    const auto relative = [&](const ReplicateMean& sum, double squared_bias) {
        const double n = static_cast<double>(count_);
        return sum.mean > 0 ? std::sqrt(n * sum.variance / (sum.mean * sum.mean) + squared_bias) : 0;
    };
    const double elements = bias.elements * bias.elements, patches = bias.patches * bias.patches;
    return {relative(factor_, elements), relative(lux_hours_, elements + patches)};
}

}  // namespace exitance

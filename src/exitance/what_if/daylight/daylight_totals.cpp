#include "exitance/what_if/daylight/daylight_totals.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Applies f(sum, value) to every part of a spread result.
template <class F>
void for_each_part(SpreadResult& sum, const SpreadResult& value, const F& f) {
    f(sum.value, value.value), f(sum.less, value.less), f(sum.more, value.more);
    for (std::size_t k = 0; k < daylight_replicates; ++k) f(sum.replicates[k], value.replicates[k]);
}

}  // namespace

DaylightTotals::DaylightTotals(std::span<const SensorGrid> grids, std::span<const DaylightHour> hours,
                               const DaylightSite& site, const DaylightCriteria& criteria)
    : grids_(grids.size()), provision_(hours, site) {
    std::size_t end = 0;
    for (const SensorGrid& grid : grids) ends_.push_back(end += grid.count);
    for (std::size_t h = 0; h < hours.size(); ++h) sums_.occupied_hours += criteria.is_occupied(hours[h], h);
}

void DaylightTotals::add(const SensorResults& sensor) {
    constexpr double max_sunny_hours = 250;
    while (grid_ + 1 < ends_.size() && sums_.sensors >= ends_[grid_]) ++grid_;
    grids_[grid_].add(sensor.linear);
    ++sums_.sensors;
    sums_.mean_daylight_factor += sensor.metrics.daylight_factor;
    sums_.spatial_autonomy += sensor.metrics.autonomy >= 0.5;
    sums_.sunlight_exposure += sensor.metrics.sunny_hours > max_sunny_hours;
    sums_.continuous_autonomy += sensor.metrics.continuous, sums_.electric_hours += sensor.metrics.electric_hours;
    sums_.most_sunlight = std::max(sums_.most_sunlight, sensor.sunlight);
    for_each_part(factor_, sensor.factor, [](double& sum, double v) { sum += v; });
    for_each_part(reached_, sensor.autonomy, [](double& count, double v) { count += v >= 0.5; });
    provision_.add(sensor.reached, sensor.metrics.daylight_factor);
}

DaylightSummary DaylightTotals::summary(const DaylightBias& bias) const {
    DaylightSummary out = sums_;
    const double n = std::max<double>(1, static_cast<double>(sums_.sensors));
    out.mean_daylight_factor /= n, out.spatial_autonomy /= n, out.sunlight_exposure /= n;
    out.continuous_autonomy /= n, out.electric_hours /= n;
    SpreadResult factor, reached;
    const auto divide = [n](double& mean, double sum) { mean = sum / n; };
    for_each_part(factor, factor_, divide), for_each_part(reached, reached_, divide);
    out.mean_factor = factor.interval();
    const Interval bounds = reached.interval();
    out.spatial_autonomy_bounds = {std::max(0.0, bounds.low), std::min(1.0, bounds.high)};
    out.provision = provision_.provision(), out.bias = bias;
    for (const GridErrorSum& grid : grids_)
        out.errors.push_back(grid.error(bias)), out.grid_factors.push_back(grid.mean_factor());
    return out;
}

}  // namespace exitance

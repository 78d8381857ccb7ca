#include "exitance/what_if/daylight/daylight_totals.hpp"

#include <algorithm>

namespace exitance {

DaylightTotals::DaylightTotals(std::span<const SensorGrid> grids, std::span<const DaylightHour> hours,
                               const DaylightSite& site, const DaylightCriteria& criteria)
    : grids_(grids.size()), provision_(hours, site) {
    std::size_t end = 0;
    for (const SensorGrid& grid : grids) ends_.push_back(end += grid.count);
    for (std::size_t h = 0; h < hours.size(); ++h) sums_.occupied_hours += criteria.is_occupied(hours[h], h);
}

void DaylightTotals::add(const SensorResults& sensor) {
    while (grid_ + 1 < ends_.size() && sums_.sensors >= ends_[grid_]) ++grid_;
    grids_[grid_].add(sensor.linear);
    ++sums_.sensors;
    sums_.mean_daylight_factor += sensor.metrics.daylight_factor;
    sums_.spatial_autonomy += sensor.metrics.autonomy >= required_autonomy;
    sums_.sunlight_exposure += sensor.metrics.sunny_hours > max_sunny_hours;
    sums_.continuous_autonomy += sensor.metrics.continuous, sums_.electric_hours += sensor.metrics.electric_hours;
    sums_.max_sunlight = std::max(sums_.max_sunlight, sensor.sunlight);
    for_each_value(factor_, sensor.factor, [](double& sum, double v) { sum += v; });
    for_each_value(reached_, sensor.autonomy, [](double& count, double v) { count += v >= required_autonomy; });
    provision_.add(sensor.reached, sensor.metrics.daylight_factor);
}

DaylightSummary DaylightTotals::summary(const DaylightBias& bias) const {
    DaylightSummary out = sums_;
    const double n = std::max<double>(1, static_cast<double>(sums_.sensors));
    out.mean_daylight_factor /= n, out.spatial_autonomy /= n, out.sunlight_exposure /= n;
    out.continuous_autonomy /= n, out.electric_hours /= n;
    SpreadResult factor;
    for_each_value(factor, factor_, [n](double& mean, double sum) { mean = sum / n; });
    out.mean_factor = factor.interval();
    out.spatial_autonomy_bounds = share_interval(reached_, n);
    out.provision = provision_.provision(), out.bias = bias;
    for (const GridErrorSum& grid : grids_)
        out.errors.push_back(grid.error(bias)), out.grid_factors.push_back(grid.mean_factor());
    return out;
}

}  // namespace exitance

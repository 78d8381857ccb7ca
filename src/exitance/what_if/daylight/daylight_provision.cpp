#include "exitance/what_if/daylight/daylight_provision.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "exitance/direct/beams.hpp"

namespace exitance {
namespace {

constexpr int steps_per_hour = 30;  ///< Time steps per hour, for counting hours of sunlight.
constexpr int year = 2021;          ///< Year of the cloudless day.

}  // namespace

std::vector<std::size_t> daylight_hours(std::span<const DaylightHour> hours) {
    std::vector<std::size_t> order(hours.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return hours[a].diffuse_horizontal > hours[b].diffuse_horizontal;
    });
    order.resize(hours.size() / 2);
    return order;
}

double reached_by_half(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto wanted =
        static_cast<std::size_t>(std::ceil(DaylightProvision::time_share * static_cast<double>(values.size())));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(wanted - 1);
    std::nth_element(values.begin(), at, values.end(), std::greater<>());
    return *at;
}

int DaylightProvision::Shares::level() const {
    constexpr double rounding = 1e-9;
    int out = 0;
    for (std::size_t level = 0; level < 3; ++level)
        if (at_target[level] >= target_share - rounding && at_minimum[level] >= minimum_share - rounding)
            out = static_cast<int>(level) + 1;
    return out;
}

ProvisionCount::ProvisionCount(std::span<const DaylightHour> hours, const DaylightSite& site) {
    const std::vector<std::size_t> lit = daylight_hours(hours);
    hours_ = lit.size();
    std::vector<double> diffuse;
    for (const std::size_t h : lit) diffuse.push_back(site.efficacy_diffuse * hours[h].diffuse_horizontal);
    median_diffuse_ = reached_by_half(std::move(diffuse));
}

void ProvisionCount::count(double lux, DaylightProvision::Shares& counts) {
    for (std::size_t level = 0; level < 3; ++level) {
        counts.at_target[level] += lux >= DaylightProvision::targets[level];
        counts.at_minimum[level] += lux >= DaylightProvision::minimums[level];
    }
}

void ProvisionCount::add(double reached, double factor) {
    ++sensors_;
    count(reached, by_illuminance_), count(factor / 100 * median_diffuse_, by_factor_);
}

DaylightProvision ProvisionCount::provision() const {
    DaylightProvision out{hours_, by_illuminance_, median_diffuse_, by_factor_};
    const double n = std::max<double>(1, static_cast<double>(sensors_));
    for (DaylightProvision::Shares* const shares : {&out.by_illuminance, &out.by_factor})
        for (std::size_t level = 0; level < 3; ++level) shares->at_target[level] /= n, shares->at_minimum[level] /= n;
    return out;
}

SunlightHours::SunlightHours(const Occluders& occluders, const DaylightSite& site, const SunDay& day)
    : occluders_(occluders) {
    for (int step = 0; step < 24 * steps_per_hour; ++step) {
        const double hour = (step + 0.5) / steps_per_hour;
        const SunPosition at = sun_position({year, day.month, day.day, hour, site.zone}, site.place);
        if (at.altitude > std::max(0.0, day.min_altitude))
            suns_.push_back(sky_direction(at.altitude, at.azimuth, site.north));
    }
}

double SunlightHours::at(const SurfacePoint& sensor) const {
    double out = 0;
    std::vector<PunctualLight> light(1);
    light[0].kind = PunctualLight::Kind::directional, light[0].intensity = Spectrum(1);
    const Beams beams(light, occluders_);
    for (const Normal& sun : suns_) {
        if (!sensor.region.is_none() && dot(sun, sensor.n) <= 0) continue;
        light[0].direction = -sun;
        if (max(beams.irradiance({sensor.x, sun, sensor.region})) > 0) out += 1.0 / steps_per_hour;
    }
    return out;
}

}  // namespace exitance

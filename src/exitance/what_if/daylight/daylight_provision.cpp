#include "exitance/what_if/daylight/daylight_provision.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/direct/beams.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

DaylightProvision::Shares shares_of(std::span<const double> lux) {
    DaylightProvision::Shares out;
    const double n = std::max<double>(1, static_cast<double>(lux.size()));
    for (const double E : lux)
        for (std::size_t level = 0; level < 3; ++level) {
            out.at_target[level] += (E >= DaylightProvision::targets[level]) / n;
            out.at_minimum[level] += (E >= DaylightProvision::minimums[level]) / n;
        }
    return out;
}

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

DaylightProvision daylight_provision(const DaylightYear& year, std::span<const DaylightMetrics> metrics,
                                     std::span<const DaylightHour> hours, const DaylightSite& site) {
    DaylightProvision out;
    const std::vector<std::size_t> lit = daylight_hours(hours);
    out.hours = lit.size();
    std::vector<double> diffuse;
    for (const std::size_t h : lit) diffuse.push_back(site.efficacy_diffuse * hours[h].diffuse_horizontal);
    out.median_diffuse = reached_by_half(std::move(diffuse));
    out.reached.resize(year.sensors);
    std::vector<double> by_factor(year.sensors);
    parallel_for(year.sensors, 16, [&](std::size_t i) {
        std::vector<double> lux;
        for (const std::size_t h : lit) lux.push_back(double(year.illuminance[h * year.sensors + i]));
        out.reached[i] = reached_by_half(std::move(lux));
        by_factor[i] = metrics[i].daylight_factor / 100 * out.median_diffuse;
    });
    out.by_illuminance = shares_of(out.reached), out.by_factor = shares_of(by_factor);
    return out;
}

std::vector<double> sunlight_hours(const Scene& scene, std::span<const ProbePoint> sensors, const DaylightSite& site,
                                   double zone, const SunDay& day) {
    constexpr int steps_per_hour = 30, year = 2021;
    std::vector<Normal> suns;
    for (int step = 0; step < 24 * steps_per_hour; ++step) {
        const double hour = (step + 0.5) / steps_per_hour;
        const SunPosition at = sun_position({year, day.month, day.day, hour, zone}, site.place);
        if (at.altitude > std::max(0.0, day.least_altitude))
            suns.push_back(sky_direction(at.altitude, at.azimuth, site.north));
    }
    const Occluders occluders(scene);
    const std::vector<Receiver> places = sensor_places(scene, occluders, sensors);
    std::vector<double> out(sensors.size());
    parallel_for(sensors.size(), 1, [&](std::size_t i) {
        for (const Normal& sun : suns) {
            Receiver at = places[i];
            if (!at.own.is_none() && dot(sun, at.n) <= 0) continue;
            at.n = sun;
            std::vector<PunctualLight> light(1);
            light[0].kind = PunctualLight::Kind::directional, light[0].direction = -sun;
            light[0].intensity = Spectrum(1);
            if (max(Beams(light, occluders).irradiance(at)) > 0) out[i] += 1.0 / steps_per_hour;
        }
    });
    return out;
}

}  // namespace exitance

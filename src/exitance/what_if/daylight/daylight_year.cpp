#include "exitance/what_if/daylight/daylight_year.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/direct/beams.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

/// Luminances of a sky's patches, cd/m^2, scaled to `diffuse` lx on the ground. The ground's own luminance must be set
/// by the caller.
std::vector<double> luminances(const SkyModel& sky, const SkyPatches& patches, double diffuse) {
    std::vector<double> out = patches.mean_values(sky);
    double horizontal = 0;
    for (std::size_t p = 1; p < out.size(); ++p) horizontal += out[p] * patches.horizontal(p);
    for (double& v : out) v *= horizontal > 0 ? diffuse / horizontal : 0;
    return out;
}

/// Distributes the sun's light to the four nearest patches as luminances, weighted by inverse distance; for reflected
/// light, the difference is negligible.
std::vector<std::pair<std::size_t, double>> sun_in_patches(const Normal& sun, const SkyPatches& patches,
                                                           double normal) {
    constexpr std::size_t count = 4;
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t p = 1; p < patches.size(); ++p) near.push_back({-dot(patches.middle(p), sun), p});
    std::partial_sort(near.begin(), near.begin() + count, near.end());
    double all = 0;
    std::array<double, count> weight{};
    for (std::size_t i = 0; i < count; ++i) {
        constexpr double least = 1e-3;
        weight[i] = 1 / (std::acos(std::clamp(-near[i].first, -1.0, 1.0)) + least);
        all += weight[i];
    }
    std::vector<std::pair<std::size_t, double>> out;
    for (std::size_t i = 0; i < count; ++i)
        out.push_back({near[i].second, weight[i] / all * normal / patches.solid_angle(near[i].second)});
    return out;
}

/// Sky and sun of one hour.
struct HourLight {
    std::vector<double> patches;                         ///< cd/m^2
    std::vector<std::pair<std::size_t, double>> of_sun;  ///< cd/m^2, for reflected light only.
    Normal sun;
    double direct = 0;  ///< lx
    bool is_dark = true;
};

HourLight light_of(const DaylightHour& hour, const SkyPatches& patches, const DaylightSite& site) {
    HourLight out;
    if (!(hour.diffuse_horizontal > 0) && !(hour.direct_normal > 0)) return out;
    const SunPosition at = sun_position(hour.time, site.place);
    out.sun = sky_direction(at.altitude, at.azimuth, site.north);
    const double direct = out.sun.z > 0 ? hour.direct_normal : 0;
    const int day = day_of_year(hour.time.year, hour.time.month, hour.time.day);
    const double diffuse_lux = site.efficacy_diffuse * hour.diffuse_horizontal;
    out.direct = site.efficacy_direct * direct;
    out.patches.assign(patches.size(), 0);
    if (hour.diffuse_horizontal > 0)
        out.patches = luminances(perez_sky({hour.diffuse_horizontal, direct, day}, out.sun), patches, diffuse_lux);
    out.patches[0] = site.ground * (diffuse_lux + out.direct * std::max(0.0, out.sun.z)) / pi;
    if (out.direct > 0) out.of_sun = sun_in_patches(out.sun, patches, out.direct);
    out.is_dark = false;
    return out;
}

}  // namespace

DaylightYear daylight_year(const Scene& scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                           const DaylightMatrix& matrix, std::span<const DaylightHour> hours,
                           const DaylightSite& site) {
    const std::size_t n = sensors.size(), m = patches.size();
    DaylightYear out;
    out.sensors = n;
    out.illuminance.assign(hours.size() * n, 0), out.sun.assign(hours.size() * n, 0);
    const Occluders occluders(scene);
    const std::vector<Receiver> at = sensor_places(scene, occluders, sensors);
    std::vector<float> all(n * m);  // direct and reflected
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = matrix.direct[k] + matrix.reflected[k];
    parallel_for(hours.size(), 8, [&](std::size_t h) {
        const HourLight light = light_of(hours[h], patches, site);
        if (light.is_dark) return;
        const std::vector<float> luminance(light.patches.begin(), light.patches.end());
        std::vector<PunctualLight> sun(1);
        sun[0].kind = PunctualLight::Kind::directional, sun[0].direction = -light.sun;
        sun[0].intensity = Spectrum(light.direct);
        const Beams beams(sun, occluders);
        for (std::size_t i = 0; i < n; ++i) {
            const float* row = &all[i * m];
            float sum = 0;
            for (std::size_t p = 0; p < m; ++p) sum += row[p] * luminance[p];
            double straight = 0, reflected = 0;
            // A sensor that sees none of the sun's patches does not see the sun.
            const auto is_seen = [&](const auto& part) { return matrix.direct[i * m + part.first] > 0; };
            if (light.direct > 0 && dot(light.sun, at[i].n) > 0 &&
                std::any_of(light.of_sun.begin(), light.of_sun.end(), is_seen)) {
                straight = luminous_sum(beams.irradiance(at[i]));
            }
            for (const auto& [patch, L] : light.of_sun) reflected += double(matrix.reflected[i * m + patch]) * L;
            out.sun[h * n + i] = static_cast<float>(straight);
            out.illuminance[h * n + i] = sum + static_cast<float>(straight + reflected);
        }
    });
    return out;
}

std::vector<DaylightMetrics> daylight_metrics(const DaylightYear& year, const SkyPatches& patches,
                                              const DaylightMatrix& matrix, std::span<const DaylightHour> hours,
                                              const DaylightSite& site) {
    constexpr double target = 300, sunny = 1000;  // lx
    constexpr std::array<double, 3> limits{100, 300, 3000};
    const std::size_t n = year.sensors, m = patches.size();
    std::vector<double> overcast = luminances(overcast_sky(), patches, 1);
    overcast[0] = site.ground / pi;
    std::vector<DaylightMetrics> out(n);
    parallel_for(n, 16, [&](std::size_t i) {
        DaylightMetrics& metrics = out[i];
        for (std::size_t p = 0; p < m; ++p) metrics.daylight_factor += 100 * overcast[p] * matrix.total(i, p);
        double occupied = 0;
        for (std::size_t h = 0; h < hours.size(); ++h) {
            const double E = double(year.illuminance[h * n + i]);
            if (!is_occupied(hours[h].hour)) continue;
            ++occupied;
            metrics.sunny_hours += double(year.sun[h * n + i]) > sunny;
            metrics.autonomy += E >= target;
            std::size_t k = 0;
            while (k < limits.size() && E >= limits[k]) ++k;
            ++metrics.useful[k];
        }
        if (!(occupied > 0)) return;
        metrics.autonomy /= occupied;
        for (double& share : metrics.useful) share /= occupied;
    });
    return out;
}

DaylightSummary summarize(std::span<const DaylightMetrics> metrics, std::span<const DaylightHour> hours) {
    constexpr double half = 0.5, max_sunny_hours = 250;
    DaylightSummary out;
    for (const DaylightHour& hour : hours) out.occupied_hours += is_occupied(hour.hour);
    for (const DaylightMetrics& m : metrics) {
        out.mean_daylight_factor += m.daylight_factor;
        out.spatial_autonomy += m.autonomy >= half;
        out.sunlight_exposure += m.sunny_hours > max_sunny_hours;
    }
    const double n = std::max<double>(1, static_cast<double>(metrics.size()));
    out.mean_daylight_factor /= n, out.spatial_autonomy /= n, out.sunlight_exposure /= n;
    return out;
}

}  // namespace exitance

#include "exitance/what_if/daylight/daylight_year.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/processor.hpp"
#include "exitance/scene/sky/perez_sky.hpp"

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

/// Returns the four patches nearest to the sun, and the luminances that replace the sun's light there, weighted by
/// inverse distance. This is accurate enough for light that is reflected at least once.
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

}  // namespace

YearSky::YearSky(const SkyPatches& patches, std::span<const DaylightHour> hours, const DaylightSite& site)
    : patches_(patches.size()), suns_(hours.size()) {
    sum_of_sky_.assign(patches_, 0), sum_with_sun_.assign(patches_, 0);
    for (std::size_t h = 0; h < hours.size(); ++h) {
        const DaylightHour& hour = hours[h];
        if (!has_light(hour)) continue;
        const SunPosition at = sun_position(hour.time, site.place);
        Sun& sun = suns_[h];
        sun.towards = sky_direction(at.altitude, at.azimuth, site.north);
        const double direct = sun.towards.z > 0 ? hour.direct_normal : 0;
        const int day = day_of_year(hour.time.year, hour.time.month, hour.time.day);
        const double diffuse_lux = site.efficacy_diffuse * hour.diffuse_horizontal;
        sun.illuminance = site.efficacy_direct * direct;
        std::vector<double> sky(patches_, 0);
        if (hour.diffuse_horizontal > 0)
            sky = luminances(unscaled_perez_sky({hour.diffuse_horizontal, direct, day}, sun.towards), patches,
                             diffuse_lux);
        sky[0] = site.ground * (diffuse_lux + sun.illuminance * std::max(0.0, sun.towards.z)) / pi;
        std::vector<double> with_sun = sky;
        if (sun.illuminance > 0) {
            std::size_t k = 0;
            for (const auto& [patch, luminance] : sun_in_patches(sun.towards, patches, sun.illuminance))
                with_sun[patch] += luminance, sun.patches[k++] = patch;
        }
        bright_.push_back(h);
        sky_.insert(sky_.end(), sky.begin(), sky.end());
        with_sun_.insert(with_sun_.end(), with_sun.begin(), with_sun.end());
        for (std::size_t p = 0; p < patches_; ++p) sum_of_sky_[p] += sky[p], sum_with_sun_[p] += with_sun[p];
    }
}

/// Multiplies in tiles of 16 sensors and 4 hours, whose sums stay in registers. Every sum adds the patches in order, so
/// that the tiles do not change its bits.
void YearSky::add(std::span<const float> luminances, std::span<const float> coefficients, std::span<float> lux) const {
    using Eight = float __attribute__((vector_size(32)));
    constexpr std::size_t width = 8, tile_sensors = 2 * width, tile_hours = 4;
    const std::size_t sensors = coefficients.size() / patches_, rows = bright_.size();
    EXI_ASSERT(lux.size() == sensors * hours());
    std::vector<float> columns(patches_ * tile_sensors);  // coefficients of a tile, a row per patch
    const auto add_tile = [&](std::size_t first) EXITANCE_INLINE_LAMBDA {
        const std::size_t count = std::min(tile_sensors, sensors - first);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t p = 0; p < patches_; ++p)
                columns[p * tile_sensors + i] = coefficients[(first + i) * patches_ + p];
        for (std::size_t row = 0; row < rows; row += tile_hours) {
            const std::size_t together = std::min(tile_hours, rows - row);
            std::array<const float*, tile_hours> luminance{};
            for (std::size_t k = 0; k < tile_hours; ++k)
                luminance[k] = &luminances[(row + std::min(k, together - 1)) * patches_];
            std::array<Eight, 2 * tile_hours> sums{};
            for (std::size_t p = 0; p < patches_; ++p) {
                Eight a, b;
                __builtin_memcpy(&a, &columns[p * tile_sensors], sizeof a);
                __builtin_memcpy(&b, &columns[p * tile_sensors + width], sizeof b);
                for (std::size_t k = 0; k < tile_hours; ++k)
                    sums[2 * k] += a * luminance[k][p], sums[2 * k + 1] += b * luminance[k][p];
            }
            for (std::size_t k = 0; k < together; ++k)
                for (std::size_t i = 0; i < count; ++i)
                    lux[(first + i) * hours() + bright_[row + k]] += sums[2 * k + i / width][i % width];
        }
    };
    for (std::size_t first = 0; first < sensors; first += tile_sensors)
        call_for_four([&]() EXITANCE_INLINE_LAMBDA { add_tile(first); });
}

std::vector<double> overcast_luminances(const SkyPatches& patches, double ground) {
    std::vector<double> out = luminances(overcast_sky(), patches, 100);
    out[0] = 100 * ground / pi;
    return out;
}

DaylightMetrics metrics_of(double factor, std::span<const float> illuminance, std::span<const float> sun,
                           std::span<const DaylightHour> hours, const DaylightCriteria& criteria) {
    const auto& limits = criteria.useful;
    DaylightMetrics metrics;
    metrics.daylight_factor = factor;
    double occupied = 0;
    for (std::size_t h = 0; h < illuminance.size(); ++h) {
        if (!criteria.is_occupied(hours[h], h)) continue;
        const double E = double(illuminance[h]);
        ++occupied;
        metrics.sunny_hours += double(sun[h]) > sunny_illuminance;
        metrics.autonomy += E >= criteria.target;
        metrics.continuous += std::min(1.0, E / criteria.target);
        std::size_t k = 0;
        while (k < limits.size() && E >= limits[k]) ++k;
        ++metrics.useful[k];
    }
    metrics.electric_hours = occupied - (1 - criteria.dimmed_power) * metrics.continuous;
    if (!(occupied > 0)) return metrics;
    metrics.autonomy /= occupied, metrics.continuous /= occupied;
    for (double& share : metrics.useful) share /= occupied;
    return metrics;
}

}  // namespace exitance

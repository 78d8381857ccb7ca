#include "exitance/what_if/daylight/daylight_error.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

constexpr std::size_t bias_sensors = 32;  ///< Enough for a relative standard error of the bias of 1 / sqrt(2 * 32).
constexpr std::size_t compared_hours = 64;

/// Up to `bias_sensors` sensors, one at random from each of as many equal ranges.
std::vector<std::size_t> random_sensors(std::size_t count, std::uint64_t seed) {
    const std::size_t n = std::min(count, bias_sensors);
    RandomStream random(seed, Stream::certificate);
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < n; ++k)
        out.push_back(static_cast<std::size_t>((static_cast<double>(k) + random.uniform()) / static_cast<double>(n) *
                                               static_cast<double>(count)));
    return out;
}

/// Result at a sensor that is linear in its coefficients, for each replicate.
class Linear {
  public:
    Linear(const DaylightMatrix& matrix, const std::vector<double>& direct, const std::vector<double>& reflected)
        : matrix_(matrix), direct_(direct), reflected_(reflected) {}

    /// Mean of the replicates, and variance of this mean.
    struct Value {
        double mean = 0, variance = 0;
    };
    Value at(std::size_t sensor) const {
        const double straight = sum(matrix_.direct, sensor, direct_);
        double all = 0, squares = 0;
        for (const std::vector<float>& replicate : matrix_.replicates) {
            const double value = straight + sum(replicate, sensor, reflected_);
            all += value, squares += value * value;
        }
        constexpr auto n = static_cast<double>(daylight_replicates);
        return {all / n, std::max(0.0, squares - all * all / n) / (n * (n - 1))};
    }

  private:
    double sum(const std::vector<float>& coefficients, std::size_t sensor, const std::vector<double>& weights) const {
        double out = 0;
        for (std::size_t p = 0; p < matrix_.patches; ++p)
            out += double(coefficients[sensor * matrix_.patches + p]) * weights[p];
        return out;
    }

    const DaylightMatrix& matrix_;
    const std::vector<double>&direct_, &reflected_;
};

/// The overcast sky and the ground below it with 100 lx, so that illuminances are daylight factors.
DistantLight overcast_light(double ground) {
    SkyModel below = uniform_sky();
    below.below = true;
    return {{{overcast_sky(), Spectrum(100)}, {below, Spectrum(100 * ground)}}, {}};
}

/// RMS difference of the daylight factors to those of unbiased paths, apart from the noise of both, relative to the
/// mean. Counts one standard error of the measurement as error, so that chance does not hide a bias.
double bias_of_elements(const DaylightSetting& setting, const DaylightMatrix& matrix,
                        const std::vector<std::size_t>& chosen, double accuracy, Progress& progress,
                        const StopRequest& stop) {
    Scene scene = setting.scene;
    scene.put_under(overcast_light(setting.site.ground));
    std::vector<ProbePoint> points;
    for (const std::size_t i : chosen) points.push_back(setting.sensors[i]);
    const std::vector<double> overcast = overcast_luminances(setting.patches, setting.site.ground);
    const Linear factors(matrix, overcast, overcast);
    const double n = static_cast<double>(points.size());
    constexpr std::size_t first_paths = 256, most_paths = 65'536;
    for (std::size_t paths = first_paths;; paths *= 4) {
        const std::vector<ReferenceLight> exact =
            reference_light(scene, points, paths, hash(setting.options.seed, paths), progress, stop);
        if (exact.size() < points.size()) return 0;  // stopped: the caller discards the result
        double mean = 0, noise = 0, sum = 0, squares = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const Linear::Value value = factors.at(chosen[k]);
            const double E = luminous_sum(exact[k].irradiance), se = luminous_sum(exact[k].standard_error);
            const double excess = (value.mean - E) * (value.mean - E) - value.variance - se * se;
            mean += E / n, noise += se * se / n, sum += excess / n, squares += excess * excess / n;
        }
        const bool is_accurate = noise <= accuracy * accuracy * mean * mean / 9;
        if (!is_accurate && paths < most_paths) continue;
        const double error_of_sum = std::sqrt(std::max(0.0, squares - sum * sum) / n);
        return mean > 0 ? std::sqrt(std::max(0.0, sum + error_of_sum)) / mean : 0;
    }
}

/// Hours with light, chosen at random.
std::vector<DaylightHour> random_hours(std::span<const DaylightHour> hours, std::uint64_t seed) {
    std::vector<DaylightHour> lit, out;
    for (const DaylightHour& hour : hours)
        if (hour.diffuse_horizontal > 0) lit.push_back(hour);
    RandomStream random(seed, Stream::certificate, 1);
    for (std::size_t k = 0; k < std::min(compared_hours, lit.size()); ++k)
        out.push_back(lit[static_cast<std::size_t>(random.uniform() * static_cast<double>(lit.size()))]);
    return out;
}

/// RMS difference of the light of random hours to that with finer patches and the same rays, relative to the mean.
double bias_of_patches(const DaylightSetting& setting, const DaylightMatrix& matrix,
                       const std::vector<std::size_t>& chosen, Progress& progress) {
    constexpr int finest = 4;
    const std::vector<DaylightHour> hours = random_hours(setting.hours, setting.options.seed);
    if (setting.division >= finest || hours.empty()) return 0;
    std::vector<ProbePoint> points;
    for (const std::size_t i : chosen) points.push_back(setting.sensors[i]);
    const SkyPatches fine(2 * setting.division);
    const YearSky coarse_sky(setting.patches, hours, setting.site), fine_sky(fine, hours, setting.site);
    // The comparison needs the sum of the hours alone: one column instead of one for every fine patch.
    const DaylightMatrix finer = make_daylight_column(setting.scene, points, fine, fine_sky.sum_of_sky(),
                                                      fine_sky.sum_with_sun(), setting.options, progress);
    const std::vector<double> as_it_is{1};
    const Linear coarse_light(matrix, coarse_sky.sum_of_sky(), coarse_sky.sum_with_sun()),
        fine_light(finer, as_it_is, as_it_is);
    double mean = 0, squares = 0;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const Linear::Value a = coarse_light.at(chosen[k]), b = fine_light.at(k);
        mean += b.mean / static_cast<double>(chosen.size());
        squares += std::max(0.0, (a.mean - b.mean) * (a.mean - b.mean) - a.variance - b.variance) /
                   static_cast<double>(chosen.size());
    }
    return mean > 0 ? std::sqrt(squares) / mean : 0;
}

}  // namespace

DaylightBias measure_daylight_bias(const DaylightSetting& setting, const DaylightMatrix& matrix, double accuracy,
                                   Progress& progress, const StopRequest& stop) {
    const std::vector<std::size_t> chosen = random_sensors(setting.sensors.size(), setting.options.seed);
    if (chosen.empty()) return {};
    DaylightBias out{.sensors = chosen.size()};
    out.elements = bias_of_elements(setting, matrix, chosen, accuracy, progress, stop);
    out.patches = bias_of_patches(setting, matrix, chosen, progress);
    return out;
}

std::vector<DaylightError> daylight_errors(const DaylightSetting& setting, const DaylightMatrix& matrix,
                                           const DaylightBias& bias, std::span<const SensorGrid> grids) {
    const std::vector<double> overcast = overcast_luminances(setting.patches, setting.site.ground);
    const Linear factors(matrix, overcast, overcast),
        lux_hours(matrix, setting.sky.sum_of_sky(), setting.sky.sum_with_sun());
    std::vector<DaylightError> out;
    std::size_t first = 0;
    for (const SensorGrid& grid : grids) {
        const auto error = [&](const Linear& result, double squared_bias) {
            double mean = 0, variance = 0;
            for (std::size_t i = first; i < first + grid.count; ++i) {
                const Linear::Value value = result.at(i);
                mean += value.mean, variance += value.variance;
            }
            const double n = static_cast<double>(grid.count);
            return mean > 0 ? std::sqrt(n * variance / (mean * mean) + squared_bias) : 0;
        };
        const double elements = bias.elements * bias.elements, patch = bias.patches * bias.patches;
        out.push_back({error(factors, elements), error(lux_hours, elements + patch)});
        first += grid.count;
    }
    return out;
}

}  // namespace exitance

#include "exitance/what_if/daylight/daylight_sample.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/processes/exchange_archived.hpp"
#include "exitance/reference/path_reference.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

constexpr std::size_t bias_sensors = 32;  ///< Enough for a relative standard error of the bias of 1 / sqrt(2 * 32).
constexpr std::size_t compared_hours = 64;
constexpr std::size_t max_of_a_grid = 256, min_of_a_grid = 8;  ///< Sensors of the sample.
constexpr std::size_t max_sensors = 2048;  ///< Sensors of the sample together, unless there are very many grids.

/// Returns up to `most` different ones of `count` indices, in order: one at random from each of as many equal ranges.
std::vector<std::size_t> random_indices(std::size_t count, std::size_t most, RandomStream random) {
    const std::size_t n = std::min(count, most);
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < n; ++k)
        out.push_back(static_cast<std::size_t>((static_cast<double>(k) + random.uniform()) / static_cast<double>(n) *
                                               static_cast<double>(count)));
    // Neighbouring ranges of less than two indices may choose the same one.
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
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

double sum_of(std::span<const float> coefficients, const std::vector<double>& luminances) {
    double out = 0;
    for (std::size_t p = 0; p < luminances.size(); ++p) out += double(coefficients[p]) * luminances[p];
    return out;
}

/// The overcast sky and the ground below it with 100 lx, so that illuminances are daylight factors.
DistantLight overcast_light(double ground) {
    SkyModel below = uniform_sky();
    below.below = true;
    return {{{overcast_sky(), Spectrum(100)}, {below, Spectrum(100 * ground)}}, {}};
}

/// Unbiased light at points, pooled from several runs.
class PooledPaths {
  public:
    PooledPaths(Scene scene, std::vector<ProbePoint> points)
        : scene_(std::move(scene)),
          points_(std::move(points)),
          sum_(points_.size(), 0),
          squared_error_(points_.size(), 0) {}

    /// Adds `paths` paths per point. Returns false after a stop request, when the result is incomplete.
    bool add(std::size_t paths, std::uint64_t seed, Progress& progress, const StopRequest& stop) {
        const std::vector<ReferenceLight> found =
            reference_light(scene_, points_, paths, hash(seed, paths_), progress, stop);
        if (found.size() < points_.size()) return false;
        const double n = static_cast<double>(paths);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const double se = n * luminous_sum(found[k].standard_error);
            sum_[k] += n * luminous_sum(found[k].irradiance), squared_error_[k] += se * se;
        }
        paths_ += paths;
        return true;
    }

    std::size_t paths() const { return paths_; }
    double light(std::size_t point) const { return sum_[point] / static_cast<double>(paths_); }
    double variance(std::size_t point) const {
        return squared_error_[point] / (static_cast<double>(paths_) * static_cast<double>(paths_));
    }

  private:
    Scene scene_;
    std::vector<ProbePoint> points_;
    std::size_t paths_ = 0;
    std::vector<double> sum_, squared_error_;
};

/// A mean square over sensors, and the standard error of this mean.
struct MeanSquare {
    double mean = 0, error = 0;
    /// Root of the mean (at least 0) plus one standard error, so that chance does not hide a bias.
    double bound() const { return std::sqrt(std::max(0.0, mean) + error); }
};
MeanSquare mean_square(const std::vector<double>& squares) {
    const double n = std::max<double>(1, static_cast<double>(squares.size()));
    double sum = 0, square = 0;
    for (const double v : squares) sum += v / n, square += v * v / n;
    return {sum, std::sqrt(std::max(0.0, square - sum * sum) / n)};
}

}  // namespace

DaylightSample::DaylightSample(const DaylightSetting& setting, const DaylightTransport& transport)
    : setting_(setting),
      overcast_(overcast_luminances(setting.patches, setting.site.ground)),
      random_hours_(random_hours(setting.hours, setting.seed)),
      sky_(std::make_unique<YearSky>(setting.patches, random_hours_, setting.site)) {
    if (setting.finer) finer_sky_ = std::make_unique<YearSky>(*setting.finer, random_hours_, setting.site);
    choose_sensors(transport);
    find_direct(transport);
}

void DaylightSample::choose_sensors(const DaylightTransport& transport) {
    const std::size_t most =
        std::clamp(max_sensors / std::max<std::size_t>(1, setting_.grids.size()), min_of_a_grid, max_of_a_grid);
    std::vector<ProbePoint> points;
    std::size_t first = 0;
    for (std::size_t g = 0; g < setting_.grids.size(); ++g) {
        const RandomStream random(setting_.seed, Stream::certificate, 2, g);
        for (const std::size_t i : random_indices(setting_.grids[g].count, most, random)) {
            sensors_.push_back({first + i, g, {}, {}, {}, {}, {}, {}});
            points.push_back(setting_.sensors[first + i]);
        }
        first += setting_.grids[g].count;
    }
    const std::vector<SurfacePoint> places = sensor_places(setting_.scene, transport.stage().occluders, points);
    for (std::size_t k = 0; k < sensors_.size(); ++k) sensors_[k].at = places[k], index_[sensors_[k].number] = k;
    for_bias_ = random_indices(sensors_.size(), bias_sensors, RandomStream(setting_.seed, Stream::certificate));
}

void DaylightSample::find_direct(const DaylightTransport& transport) {
    const Occluders& occluders = transport.stage().occluders;
    const VisiblePatches visible(occluders, setting_.patches);
    for (Sensor& sensor : sensors_) sensor.known.direct.resize(setting_.patches.size());
    shared_ranges(
        sensors_.size(), 4,
        [&](std::size_t begin, std::size_t end) {
            VisiblePatches::Workspace workspace;
            for (std::size_t k = begin; k < end; ++k)
                visible.irradiance(sensors_[k].at, workspace, sensors_[k].known.direct);
        },
        [&](std::size_t k) { return std::span(sensors_[k].known.direct); }, {"visible sky"});
    if (!setting_.finer) return;
    const VisiblePatches finer(occluders, *setting_.finer);
    for (const std::size_t k : for_bias_) sensors_[k].direct_finer.resize(setting_.finer->size());
    shared_ranges(
        for_bias_.size(), 1,
        [&](std::size_t begin, std::size_t end) {
            VisiblePatches::Workspace workspace;
            for (std::size_t k = begin; k < end; ++k) {
                Sensor& sensor = sensors_[for_bias_[k]];
                finer.irradiance(sensor.at, workspace, sensor.direct_finer);
            }
        },
        [&](std::size_t k) { return std::span(sensors_[for_bias_[k]].direct_finer); }, {"visible sky"});
}

void DaylightSample::forget_rays() {
    for (Sensor& sensor : sensors_) sensor.known.rays = {};
}

/// The results as right-hand sides, in the order in which evaluate() reads them.
SkyColumns DaylightSample::columns() const {
    SkyColumns out;
    out.add(overcast_);
    out.add(setting_.sky.sum_with_sun());
    if (finer_sky_) out.add(sky_->sum_with_sun()), out.add_finer(finer_sky_->sum_with_sun());
    return out;
}

void DaylightSample::evaluate(const DaylightTransport& transport, unsigned rays) {
    const ElementLight light = transport.solve(columns());
    parallel_own_ranges(sensors_.size(), 1,
                        [&](std::size_t begin, std::size_t end) {
                            for (std::size_t k = begin; k < end; ++k) {
                                transport.cast_sensor(sensors_[k].at, sensors_[k].number, rays, sensors_[k].known.rays);
                                evaluate(sensors_[k], light);
                            }
                        },
                        {"sample"});
    exchange_archived(
        std::span(sensors_), 1,
        [](auto& archive, Sensor& sensor) {
            for (RayCounts& replicate : sensor.known.rays) archive(replicate);
            archive(sensor.results, sensor.patches, sensor.finer_patches);
        },
        "sample");
}

void DaylightSample::evaluate(Sensor& sensor, const ElementLight& light) const {
    const std::vector<float>& direct = sensor.known.direct;
    std::vector<double> straight{sum_of(direct, overcast_), sum_of(direct, setting_.sky.sum_of_sky())};
    if (!sensor.direct_finer.empty())
        straight.push_back(sum_of(direct, sky_->sum_of_sky())),
            straight.push_back(sum_of(sensor.direct_finer, finer_sky_->sum_of_sky()));
    std::vector<float> reflected(light.columns);
    const std::array<Replicates*, 4> results{&sensor.results.factor, &sensor.results.lux_hours, &sensor.patches,
                                             &sensor.finer_patches};
    for (std::size_t k = 0; k < daylight_replicates; ++k) {
        light.gather(k, sensor.known.rays[k], reflected);
        for (std::size_t c = 0; c < straight.size(); ++c) (*results[c])[k] = straight[c] + double(reflected[c]);
    }
}

std::vector<DaylightError> DaylightSample::errors(const DaylightBias& bias) const {
    std::vector<GridErrorSum> sums(setting_.grids.size());
    for (const Sensor& sensor : sensors_) sums[sensor.grid].add(sensor.results);
    std::vector<DaylightError> out;
    for (const GridErrorSum& sum : sums) out.push_back(sum.error(bias));
    return out;
}

DaylightBias DaylightSample::measure_bias(double error, Progress& progress, const StopRequest& stop) const {
    if (sensors_.empty()) return {};
    return {bias_of_elements(error, progress, stop), bias_of_patches(), for_bias_.size()};
}

/// RMS difference of the daylight factors to those of unbiased paths, apart from the noise of both, relative to the
/// mean.
double DaylightSample::bias_of_elements(double error, Progress& progress, const StopRequest& stop) const {
    Scene scene = setting_.scene;
    scene.put_under(overcast_light(setting_.site.ground));
    std::vector<ProbePoint> points;
    for (const std::size_t k : for_bias_) points.push_back(setting_.sensors[sensors_[k].number]);
    PooledPaths exact(std::move(scene), points);
    const double n = static_cast<double>(points.size());
    constexpr std::size_t first_paths = 1024, max_paths = std::size_t{1} << 22;
    for (;;) {
        // A stopped run has no result, and the caller discards the bias.
        if (!exact.add(std::max(first_paths, exact.paths()), setting_.seed, progress, stop)) return 0;
        double mean = 0, noise = 0;
        std::vector<double> excess;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const ReplicateMean found = mean_of(sensors_[for_bias_[k]].results.factor);
            const double E = exact.light(k), variance = exact.variance(k);
            mean += E / n, noise += variance / n;
            excess.push_back((found.mean - E) * (found.mean - E) - found.variance - variance);
        }
        if (!(mean > 0)) return 0;
        const double bound = mean_square(excess).bound() / mean;
        const bool is_small = bound <= error / 2, is_accurate = noise <= error * error * mean * mean / 9;
        if (is_small || is_accurate || exact.paths() >= max_paths) return bound;
    }
}

/// RMS difference of the light of random hours to that with finer patches and the same rays, relative to the mean. The
/// noise of the difference, which the replicates show, does not count.
double DaylightSample::bias_of_patches() const {
    if (!finer_sky_ || random_hours_.empty()) return 0;
    double mean = 0, squares = 0;
    const double n = static_cast<double>(for_bias_.size());
    for (const std::size_t k : for_bias_) {
        Replicates difference{};
        for (std::size_t r = 0; r < daylight_replicates; ++r)
            difference[r] = sensors_[k].patches[r] - sensors_[k].finer_patches[r];
        const ReplicateMean found = mean_of(difference);
        mean += mean_of(sensors_[k].finer_patches).mean / n;
        squares += (found.mean * found.mean - found.variance) / n;
    }
    return mean > 0 ? std::sqrt(std::max(0.0, squares)) / mean : 0;
}

double DaylightSample::measure_twice(const DaylightTransport& transport) const {
    SkyColumns overcast;
    overcast.add(overcast_);
    const ElementLight total = transport.solve(overcast),
                       any = transport.solve_through(overcast, total, transport.any_group()),
                       twice = transport.solve_twice(overcast, total, any);
    const VisiblePatches visible(transport.stage().occluders, setting_.patches);
    const std::size_t n = sensors_.size(), m = setting_.patches.size(), groups = transport.pane_groups().count();
    std::vector<double> found(n), light(n);
    parallel_for(n, 1, [&](std::size_t i) {
        const Sensor& sensor = sensors_[i];
        VisiblePatches::Workspace workspace;
        std::vector<float> direct((groups + 1) * m);
        visible.irradiance_through(transport.pane_groups(), sensor.at, workspace, direct);
        light[i] = mean_of(sensor.results.factor).mean;
        found[i] = sum_of(std::span(direct).subspan(groups * m), overcast_);
        for (std::size_t k = 0; k < daylight_replicates; ++k) {
            const RayCounts& rays = sensor.known.rays[k];
            const RayCounts::Through &one = rays.through[transport.any_group()],
                                     &two = rays.through[transport.two_groups()];
            std::array<float, 1> sum{};
            twice.gather(k, rays, sum), twice.add(k, one.leaves, rays.rays, -1, sum);
            any.add(k, one.leaves, rays.rays, 1, sum), any.add(k, two.leaves, rays.rays, -1, sum);
            total.add(k, two.leaves, rays.rays, 1, sum);
            found[i] += double(sum[0]) / double(daylight_replicates);
        }
    });
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) mean += light[i], squares += found[i] * found[i];
    return mean > 0 ? std::sqrt(static_cast<double>(n) * squares) / mean : 0;
}

const KnownSensor* DaylightSample::find(std::size_t number) const {
    const auto at = index_.find(number);
    return at == index_.end() ? nullptr : &sensors_[at->second].known;
}

}  // namespace exitance

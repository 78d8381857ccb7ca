#include "exitance/what_if/daylight/sensor_year.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Sensors that are evaluated together: a tile of YearSky's products.
constexpr std::size_t tile_sensors = 16;

/// Shares lie between 0 and 1.
Interval of_share(const Interval& i) {
    return {std::max(0.0, i.low), std::min(1.0, i.high)};
}

/// Index of the first value in the results of a sensor.
enum Result : std::size_t {
    factor_result = 0,
    autonomy_result = 1,
    useful_result = 2,
    reached_result = 6,
    continuous_result = 7,
    electric_result = 8
};

}  // namespace

SensorYears::SensorYears(const DaylightSetting& setting, const DaylightBias& bias, const std::optional<SunDay>& day)
    : setting_(setting),
      bias_(bias.total()),
      overcast_(overcast_luminances(setting.patches, setting.site.ground)),
      daylight_hours_(daylight_hours(setting.hours)),
      occluders_(setting.scene),
      suns_(setting.sky) {
    if (day) sunlight_.emplace(occluders_, setting.site, *day);
}

SensorYears::Results SensorYears::results_of(double factor, std::span<const float> lux,
                                             std::span<const float> sun) const {
    const DaylightMetrics m = metrics_of(factor, lux, sun, setting_.hours, setting_.criteria);
    std::vector<double> in_daylight;
    in_daylight.reserve(daylight_hours_.size());
    for (const std::size_t h : daylight_hours_) in_daylight.push_back(double(lux[h]));
    const double reached = reached_by_half(std::move(in_daylight));
    return {m.daylight_factor, m.autonomy, m.useful[0],  m.useful[1],     m.useful[2],
            m.useful[3],       reached,    m.continuous, m.electric_hours};
}

void SensorYears::finish(const std::array<SpreadResult, result_count>& spread, SensorResults& out) const {
    std::array<Interval, result_count> interval;
    for (std::size_t r = 0; r < result_count; ++r) interval[r] = spread[r].interval();
    out.reached = spread[reached_result].value;
    out.factor = spread[factor_result], out.autonomy = spread[autonomy_result];
    SensorIntervals& s = out.intervals;
    s.factor = {std::max(0.0, interval[factor_result].low), interval[factor_result].high};
    s.autonomy = of_share(interval[autonomy_result]), s.continuous = of_share(interval[continuous_result]);
    s.electric_hours = {std::max(0.0, interval[electric_result].low), interval[electric_result].high};
    for (std::size_t k = 0; k < s.useful.size(); ++k) s.useful[k] = of_share(interval[useful_result + k]);
    s.reached = {std::max(0.0, interval[reached_result].low), interval[reached_result].high};
}

/// Evaluates `count` sensors from index `first` of a block on, whose rows of hours are 0.
void SensorYears::evaluate_tile(std::size_t first, std::size_t count, std::span<const SurfacePoint> places,
                                std::span<const StateRows> parts, DaylightBlock& block) const {
    const DaylightMatrix& matrix = block.matrix;
    const std::size_t m = matrix.patches, hours = setting_.sky.hours();
    const std::span<float> sun = std::span(block.sun).subspan(first * hours, count * hours),
                           illuminance = std::span(block.illuminance).subspan(first * hours, count * hours);
    const auto rows_of = [&](const std::vector<float>& values) {
        return std::span(values).subspan(first * m, count * m);
    };
    const std::span<const float> direct = rows_of(matrix.direct);
    for (std::size_t i = 0; i < count; ++i)
        suns_.find(occluders_, places[first + i], direct.subspan(i * m, m), sun.subspan(i * hours, hours));
    std::vector<float> straight(sun.begin(), sun.end());
    setting_.sky.add_sky(direct, straight);
    StateTile states(setting_, suns_, parts, {first, count}, sun, bias_);

    std::vector<std::array<SpreadResult, result_count>> spread(count);
    std::vector<float> lux(count * hours);
    const auto add = [&](std::span<const float> values, std::span<const float> reflected, double scale,
                         const auto& member) {
        for (std::size_t i = 0; i < count; ++i) {
            double factor = 0;
            for (std::size_t p = 0; p < m; ++p)
                factor += overcast_[p] * (double(direct[i * m + p]) + double(reflected[i * m + p]));
            const Results results = results_of(scale * factor, values.subspan(i * hours, hours),
                                               std::span<const float>(sun).subspan(i * hours, hours));
            for (std::size_t r = 0; r < result_count; ++r) member(spread[i][r]) = results[r];
        }
    };
    const std::span<const float> mean = rows_of(matrix.reflected);
    std::copy(straight.begin(), straight.end(), illuminance.begin());
    setting_.sky.add_with_sun(mean, illuminance);
    const std::vector<float> twice = states.uncertainty(illuminance);
    states.correct(illuminance, daylight_replicates);
    add(illuminance, mean, 1, [](SpreadResult& r) -> double& { return r.value; });
    const auto add_scaled = [&](double scale, const auto& member) {
        for (std::size_t k = 0; k < lux.size(); ++k) lux[k] = illuminance[k] * static_cast<float>(scale);
        for (std::size_t k = 0; k < twice.size(); ++k)
            lux[k] = std::max(0.0f, lux[k] + (scale < 1 ? -twice[k] : twice[k]));
        add(lux, mean, scale, member);
    };
    add_scaled(1 - bias_, [](SpreadResult& r) -> double& { return r.less; });
    add_scaled(1 + bias_, [](SpreadResult& r) -> double& { return r.more; });
    for (std::size_t k = 0; k < daylight_replicates; ++k) {
        const std::span<const float> reflected = rows_of(matrix.replicates[k]);
        lux = straight;
        setting_.sky.add_with_sun(reflected, lux);
        states.correct(lux, k);
        add(lux, reflected, 1, [k](SpreadResult& r) -> double& { return r.replicates[k]; });
    }
    for (std::size_t i = 0; i < count; ++i) {
        SensorResults& out = block.results[first + i];
        out.metrics = metrics_of(spread[i][factor_result].value, illuminance.subspan(i * hours, hours),
                                 sun.subspan(i * hours, hours), setting_.hours, setting_.criteria);
        finish(spread[i], out);
    }
    states.correct_sun(sun);
    const std::span<const VariantResult> variants = states.variants();
    std::copy(variants.begin(), variants.end(),
              block.variants.begin() + static_cast<std::ptrdiff_t>(first * (variants.size() / count)));
}

DaylightBlock SensorYears::evaluate(std::size_t first, std::span<const SurfacePoint> places, DaylightMatrix matrix,
                                    std::span<const StateRows> parts) const {
    const std::size_t n = places.size(), m = matrix.patches, hours = setting_.sky.hours();
    DaylightBlock block;
    block.first = first, block.matrix = std::move(matrix);
    block.illuminance.assign(n * hours, 0), block.sun.assign(n * hours, 0);
    block.results.resize(n);
    if (setting_.states) block.variants.resize(n * setting_.states->variants.size());
    parallel_for((n + tile_sensors - 1) / tile_sensors, 1, [&](std::size_t t) {
        evaluate_tile(t * tile_sensors, std::min(tile_sensors, n - t * tile_sensors), places, parts, block);
    });
    parallel_for(n, 4, [&](std::size_t i) {
        SensorResults& out = block.results[i];
        if (sunlight_) out.sunlight = sunlight_->at(places[i]);
        const auto sum = [&](const std::vector<float>& values, const std::vector<double>& luminances) {
            double total = 0;
            for (std::size_t p = 0; p < m; ++p) total += double(values[i * m + p]) * luminances[p];
            return total;
        };
        const double factor = sum(block.matrix.direct, overcast_),
                     lux_hours = sum(block.matrix.direct, setting_.sky.sum_of_sky());
        for (std::size_t k = 0; k < daylight_replicates; ++k) {
            const std::vector<float>& replicate = block.matrix.replicates[k];
            out.linear.factor[k] = factor + sum(replicate, overcast_);
            out.linear.lux_hours[k] = lux_hours + sum(replicate, setting_.sky.sum_with_sun());
        }
    });
    return block;
}

}  // namespace exitance

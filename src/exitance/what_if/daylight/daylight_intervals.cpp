#include "exitance/what_if/daylight/daylight_intervals.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Student's factor for 95% and 7 degrees of freedom: one fewer than replicates.
constexpr double student = 2.3646;
static_assert(daylight_replicates == 8);

/// The results of one sensor that have intervals.
constexpr std::size_t result_count = 7;
using Results = std::array<double, result_count>;

Results results_of(double factor, std::span<const float> illuminance, std::span<const float> sun,
                   std::span<const DaylightHour> hours, std::span<const std::size_t> lit) {
    const DaylightMetrics m = metrics_of(factor, illuminance, sun, hours);
    std::vector<double> lux;
    for (const std::size_t h : lit) lux.push_back(double(illuminance[h]));
    return {m.daylight_factor,
            m.autonomy,
            m.useful[0],
            m.useful[1],
            m.useful[2],
            m.useful[3],
            reached_by_half(std::move(lux))};
}

/// Interval of a result from its replicates and from its values with light larger or smaller by the bias. `value`: the
/// result of the mean of the replicates.
Interval interval(double value, std::span<const double> replicates, double less, double more) {
    double mean = 0, squares = 0;
    const double n = static_cast<double>(replicates.size());
    for (const double v : replicates) mean += v / n;
    for (const double v : replicates) squares += (v - mean) * (v - mean);
    const double noise = student * std::sqrt(squares / (n * (n - 1)));
    const double below = value - std::min(less, more), above = std::max(less, more) - value;
    return {value - std::hypot(noise, std::max(0.0, below)), value + std::hypot(noise, std::max(0.0, above))};
}

/// Shares lie between 0 and 1.
Interval of_share(const Interval& i) {
    return {std::max(0.0, i.low), std::min(1.0, i.high)};
}

/// Results of every sensor: of the mean, of each replicate, and with less and more light.
struct AllResults {
    std::vector<Results> mean, less, more;
    std::array<std::vector<Results>, daylight_replicates> replicates;
};

class YearOfReplicates {
  public:
    YearOfReplicates(const DaylightSetting& setting, const DaylightMatrix& matrix, const DaylightYear& year,
                     double bias)
        : setting_(setting),
          matrix_(matrix),
          year_(year),
          bias_(bias),
          sky_(setting.sky),
          overcast_(overcast_luminances(setting.patches, setting.site.ground)),
          lit_(daylight_hours(setting.hours)) {}

    AllResults results() const {
        const std::size_t n = year_.sensors;
        AllResults out;
        out.mean.resize(n), out.less.resize(n), out.more.resize(n);
        for (auto& replicate : out.replicates) replicate.resize(n);
        constexpr std::size_t block = 16;  // sensors whose coefficients stay in the processor's first cache
        parallel_for((n + block - 1) / block, 1,
                     [&](std::size_t b) { add_block(b * block, std::min(block, n - b * block), out); });
        return out;
    }

  private:
    void add_block(std::size_t first, std::size_t count, AllResults& out) const {
        const std::size_t m = matrix_.patches, hours = sky_.hours();
        std::vector<float> sun(count * hours), direct(count * hours);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t h = 0; h < hours; ++h) sun[i * hours + h] = year_.sun[h * year_.sensors + first + i];
        direct = sun;
        sky_.add_sky(std::span(matrix_.direct).subspan(first * m, count * m), direct);
        const auto add = [&](const std::vector<float>& reflected, double scale, std::vector<Results>& results) {
            std::vector<float> lux = direct;
            sky_.add_with_sun(std::span(reflected).subspan(first * m, count * m), lux);
            for (float& v : lux) v *= static_cast<float>(scale);
            for (std::size_t i = 0; i < count; ++i) {
                double factor = 0;
                for (std::size_t p = 0; p < m; ++p)
                    factor += overcast_[p] *
                              (double(matrix_.direct[(first + i) * m + p]) + double(reflected[(first + i) * m + p]));
                results[first + i] = results_of(scale * factor, std::span(lux).subspan(i * hours, hours),
                                                std::span(sun).subspan(i * hours, hours), setting_.hours, lit_);
            }
        };
        add(matrix_.reflected, 1, out.mean);
        add(matrix_.reflected, 1 - bias_, out.less);
        add(matrix_.reflected, 1 + bias_, out.more);
        for (std::size_t k = 0; k < daylight_replicates; ++k) add(matrix_.replicates[k], 1, out.replicates[k]);
    }

    const DaylightSetting& setting_;
    const DaylightMatrix& matrix_;
    const DaylightYear& year_;
    double bias_;
    const YearSky& sky_;
    std::vector<double> overcast_;
    std::vector<std::size_t> lit_;
};

/// A result of all sensors together.
template <class Of>
Interval interval_of_all(const AllResults& all, const Of& of) {
    std::array<double, daylight_replicates> replicates;
    for (std::size_t k = 0; k < daylight_replicates; ++k) replicates[k] = of(all.replicates[k]);
    return interval(of(all.mean), replicates, of(all.less), of(all.more));
}

double mean_factor(const std::vector<Results>& results) {
    double sum = 0;
    for (const Results& r : results) sum += r[0];
    return sum / std::max<double>(1, static_cast<double>(results.size()));
}

double spatial_autonomy(const std::vector<Results>& results) {
    constexpr double half = 0.5;
    double reached = 0;
    for (const Results& r : results) reached += r[1] >= half;
    return reached / std::max<double>(1, static_cast<double>(results.size()));
}

}  // namespace

DaylightIntervals daylight_intervals(const DaylightSetting& setting, const DaylightMatrix& matrix,
                                     const DaylightYear& year, const DaylightBias& bias) {
    const AllResults all = YearOfReplicates(setting, matrix, year, std::hypot(bias.elements, bias.patches)).results();
    DaylightIntervals out;
    out.sensors.resize(year.sensors);
    for (std::size_t i = 0; i < year.sensors; ++i) {
        std::array<Interval, result_count> of;
        for (std::size_t r = 0; r < result_count; ++r) {
            std::array<double, daylight_replicates> replicates;
            for (std::size_t k = 0; k < daylight_replicates; ++k) replicates[k] = all.replicates[k][i][r];
            of[r] = interval(all.mean[i][r], replicates, all.less[i][r], all.more[i][r]);
        }
        SensorIntervals& s = out.sensors[i];
        s.factor = {std::max(0.0, of[0].low), of[0].high};
        s.autonomy = of_share(of[1]);
        for (std::size_t k = 0; k < s.useful.size(); ++k) s.useful[k] = of_share(of[2 + k]);
        s.reached = {std::max(0.0, of[6].low), of[6].high};
    }
    out.mean_factor = interval_of_all(all, mean_factor);
    out.spatial_autonomy = of_share(interval_of_all(all, spatial_autonomy));
    return out;
}

}  // namespace exitance

#include "exitance/what_if/daylight/daylight_results.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

double worst(const std::vector<DaylightError>& errors) {
    double out = 0;
    for (const DaylightError& e : errors) out = std::max({out, e.factor, e.lux_hours});
    return out;
}

/// Computes the matrix until the error of every grid is reached: first rays, until noise leaves room for the bias, then
/// elements.
class MatrixSearch {
  public:
    MatrixSearch(DaylightSetting setting, double error, DaylightResults& results, Progress& progress,
                 const StopRequest& stop)
        : setting_(setting), error_(error), results_(results), progress_(progress), stop_(stop) {}

    void find() {
        constexpr int most_computations = 7;
        const double share = std::sqrt(0.5);  // noise and bias may each have half of the squared error
        for (int k = 0; k < most_computations && !stop_.requested(); ++k) {
            results_.matrix =
                make_daylight_matrix(setting_.scene, setting_.sensors, setting_.patches, setting_.options, progress_);
            results_.bias = {};
            const double noise = worst(errors());
            if (noise > share * error_) {
                setting_.options.rays_an_element *= 4, setting_.options.rays_a_sensor *= 4;
                continue;
            }
            progress_.phase("error");
            results_.bias = measure_daylight_bias(setting_, results_.matrix, error_, progress_, stop_);
            if (worst(errors()) <= error_ || results_.bias.elements <= share * error_) break;
            setting_.options.elements *= 4;
        }
        results_.errors = errors();
    }

  private:
    std::vector<DaylightError> errors() const {
        return daylight_errors(setting_, results_.matrix, results_.bias, results_.grids);
    }

    DaylightSetting setting_;
    double error_;
    DaylightResults& results_;
    Progress& progress_;
    const StopRequest& stop_;
};

}  // namespace

Result<void> simulate_year(const Scene& scene, int division, const DaylightSite& site, double error,
                           DaylightResults& results, Progress& progress, const StopRequest& stop) {
    // A first computation that suffices for a simple room at 2%.
    constexpr DaylightOptions first{.elements = 1500, .rays_an_element = 64, .rays_a_sensor = 1024};
    const SkyPatches patches(division);
    const YearSky sky(patches, results.hours, site);
    const DaylightSetting setting{scene, results.sensors, division, patches, results.hours, site, sky, first};
    MatrixSearch(setting, error, results, progress, stop).find();
    const auto stopped = [] {
        return Error{ErrorCode::limit, "stopped before the results of the year were complete", "", ""};
    };
    if (stop.requested()) return stopped();
    progress.phase("year");
    results.year = daylight_year(scene, results.sensors, results.matrix, sky);
    results.metrics = daylight_metrics(results.year, patches, results.matrix, results.hours, site);
    results.intervals = daylight_intervals(setting, results.matrix, results.year, results.bias);
    results.summary = summarize(results.metrics, results.hours);
    results.provision = daylight_provision(results.year, results.metrics, results.hours, site);
    if (stop.requested()) return stopped();
    return {};
}

}  // namespace exitance

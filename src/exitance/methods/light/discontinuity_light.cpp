#include "exitance/methods/light/discontinuity_light.hpp"

#include "exitance/mesh/element_locator.hpp"

namespace exitance {

DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop) {
    const ElementLocator locator(solution.indirect.tree, solution.scene.regions().size());
    DiscontinuityOptions ask{.error = options.error_interpolant.value_or(options.error_target()),
                             .direct_weight = Spectrum(1.0) - solution.direct_share,
                             .seed = options.seed};
    constexpr double largest = 5.0 / 3;  // times the RMS, of the largest value: 0.5% where 0.3% is asked for
    ask.largest_error = largest * ask.error;
    if (options.bounces != 0)
        ask.indirect = [&](RegionId r, const Point& p) { return solution.indirect.at(locator.find(r, p)); };
    DiscontinuityReport report;
    solution.discontinuity = make_discontinuity_mesh(stage, ask, report, stop);
    solution.interpolant = linear_elements(solution.discontinuity, solution.scene);
    SolveStatistics& statistics = solution.statistics;
    statistics.discontinuity = report.counts;
    statistics.elements = statistics.leaf_elements = report.counts.triangles;
    if (statistics.relative_error_estimate && !report.interrupted)
        statistics.relative_error_estimate_interpolant = std::hypot(report.error, *statistics.relative_error_estimate);
    return report;
}

}  // namespace exitance

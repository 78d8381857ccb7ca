#include "exitance/methods/light/discontinuity_light.hpp"

#include <algorithm>

#include "exitance/base/progress.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/methods/extensions.hpp"
#include "exitance/methods/light/secondary_light.hpp"

namespace exitance {
namespace {

ConicCurves conics_of(ThreeEdgeEvents asked) {
    return asked == ThreeEdgeEvents::on    ? ConicCurves::all
           : asked == ThreeEdgeEvents::off ? ConicCurves::none
                                           : ConicCurves::at_umbras;
}

/// Direct light in layers, if requested.
LayeredLight make_layers(const Stage& stage, const DiscontinuityOptions& options, DiscontinuityReport& report,
                         const StopRequest& stop) {
    const Stopwatch watch;
    LayeredLight layers = extensions().discontinuity->make_layers(stage, options, stop);
    report.direct_seconds = watch.seconds();
    report.interrupted = layers.interrupted;
    return layers;
}

}  // namespace

DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points) {
    const ElementLocator locator(solution.indirect.tree, solution.scene.regions().size());
    DiscontinuityOptions ask{.error = options.error_interpolant.value_or(options.error_target()),
                             .direct_weight = Spectrum(1.0) - solution.direct_share,
                             .seed = options.seed,
                             .safe_points = safe_points};
    const DiscontinuityChoice& choice = options.discontinuity;
    ask.largest_error = choice.largest_error.value_or(calibrated::largest_dm_error * ask.error);
    ask.lines = choice.lines.value_or(ShadowLines());
    if (choice.sources && options.bounces != 0)
        ask.secondary = secondary_sources(stage, solution, locator, *choice.sources, stop);
    const SecondaryLight secondary(stage, solution.indirect, locator, ask.secondary, stop);
    if (options.bounces != 0) ask.indirect = [&](RegionId r, const Point& p) { return secondary.at(r, p); };
    ask.conics = conics_of(choice.three_edges.value_or(ThreeEdgeEvents::automatic));
    if (extensions().discontinuity) extensions().discontinuity->choose(choice, ask);
    ask.refined = choice.quality == MeshQuality::delaunay;
    ask.clough_tocher = choice.element == MeshElement::clough_tocher;
    DiscontinuityReport report;
    LayeredLight layers;
    if (choice.layers == true) layers = make_layers(stage, ask, report, stop);
    if (layers.interrupted) return report;
    solution.discontinuity = make_discontinuity_mesh(stage, ask, report, stop);
    report.error = std::max(report.error, layers.error);
    if (!solution.discontinuity.empty()) solution.layers = layers.form;
    solution.interpolant = linear_elements(solution.discontinuity, solution.scene);
    SolveStatistics& statistics = solution.statistics;
    statistics.discontinuity = report.counts;
    if (choice.element == MeshElement::clough_tocher)
        statistics.basis = name_in(mesh_element_names, MeshElement::clough_tocher);
    statistics.elements = statistics.leaf_elements = report.counts.triangles;
    statistics.figures["candidate_share"] = report.candidate_share;
    if (report.resumed_receivers > 0) {
        statistics.figures["resumed_receivers"] = static_cast<double>(report.resumed_receivers);
        statistics.figures["resumed_nodes"] = static_cast<double>(report.resumed_nodes);
    }
    if (choice.sources) {
        statistics.figures["secondary_sources"] = static_cast<double>(ask.secondary.size());
        std::size_t parts = 0;
        for (const SecondarySource& source : ask.secondary) parts += source.parts.size();
        statistics.figures["secondary_parts"] = static_cast<double>(parts);
        statistics.figures["secondary_curves"] = static_cast<double>(report.secondary_curves);
    }
    if (report.tree_bytes > 0) statistics.figures["dm_tree_bytes"] = static_cast<double>(report.tree_bytes);
    if (!solution.layers && extensions().discontinuity)
        layers.figures = extensions().discontinuity->figures(solution.discontinuity);
    statistics.figures.insert(layers.figures.begin(), layers.figures.end());
    if (ask.search) {
        statistics.figures["plane_tests"] = static_cast<double>(report.plane_tests);
        statistics.figures["fragments"] = static_cast<double>(report.fragments);
    }
    if (statistics.relative_error_estimate && !report.interrupted)
        statistics.relative_error_estimate_interpolant = std::hypot(report.error, *statistics.relative_error_estimate);
    return report;
}

}  // namespace exitance

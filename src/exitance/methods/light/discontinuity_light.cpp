#include "exitance/methods/light/discontinuity_light.hpp"

#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/evaluate/layer_elements.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/methods/light/secondary_light.hpp"

namespace exitance {
namespace {

ConicCurves conics_of(ThreeEdgeEvents asked) {
    return asked == ThreeEdgeEvents::on    ? ConicCurves::all
           : asked == ThreeEdgeEvents::off ? ConicCurves::none
                                           : ConicCurves::at_umbras;
}

/// Sources and options of a mesh of a solution. Refers to the arguments of its constructor.
struct MeshTask {
    MeshTask(const Stage& stage, const SolveOptions& options, const Solution& solution, const StopRequest& stop)
        : locator(solution.indirect.tree, solution.scene.regions().size()),
          sources(options.discontinuity.sources && options.bounces != 0
                      ? secondary_sources(stage, solution, locator, *options.discontinuity.sources, stop)
                      : std::vector<SecondarySource>()),
          secondary(stage, solution.indirect, locator, sources, stop),
          ask{.error = options.error_interpolant.value_or(options.error_target()),
              .direct_weight = Spectrum(1.0) - solution.direct_share,
              .secondary = sources,
              .seed = options.seed} {
        const DiscontinuityChoice& choice = options.discontinuity;
        ask.largest_error = choice.largest_error.value_or(calibrated::largest_dm_error * ask.error);
        ask.lines = choice.lines.value_or(ShadowLines());
        if (options.bounces != 0) ask.indirect = [&](RegionId r, const Point& p) { return secondary.at(r, p); };
        ask.conics = conics_of(choice.three_edges.value_or(ThreeEdgeEvents::automatic));
        if (extensions().discontinuity) extensions().discontinuity->choose(choice, ask);
        ask.refined = choice.quality == MeshQuality::delaunay;
        ask.clough_tocher = choice.element == MeshElement::clough_tocher;
    }
    MeshTask(const MeshTask&) = delete;
    MeshTask& operator=(const MeshTask&) = delete;

    const ElementLocator locator;
    const std::vector<SecondarySource> sources;
    const SecondaryLight secondary;
    DiscontinuityOptions ask;
};

/// Records the numbers of a mesh or of layers in the statistics.
void record_mesh(const DiscontinuityReport& report, const MeshTask& task, const DiscontinuityChoice& choice,
                 SolveStatistics& statistics) {
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
        statistics.figures["secondary_sources"] = static_cast<double>(task.sources.size());
        std::size_t parts = 0;
        for (const SecondarySource& source : task.sources) parts += source.parts.size();
        statistics.figures["secondary_parts"] = static_cast<double>(parts);
        statistics.figures["secondary_curves"] = static_cast<double>(report.secondary_curves);
    }
    if (report.tree_bytes > 0) statistics.figures["dm_tree_bytes"] = static_cast<double>(report.tree_bytes);
    if (task.ask.search) {
        statistics.figures["plane_tests"] = static_cast<double>(report.plane_tests);
        statistics.figures["fragments"] = static_cast<double>(report.fragments);
    }
    if (statistics.relative_error_estimate && !report.interrupted)
        statistics.relative_error_estimate_interpolant = std::hypot(report.error, *statistics.relative_error_estimate);
}

/// Adds layers of direct light to the solution.
DiscontinuityReport add_layers(const Stage& stage, const SolveOptions& options, const MeshTask& task,
                               Solution& solution, const StopRequest& stop, const ShowLayers& show) {
    LayeredLight layers = extensions().discontinuity->make_layers(stage, task.ask, options, show, stop);
    if (layers.report.interrupted || !layers.form) return layers.report;
    solution.layers = std::move(layers.form);
    record_mesh(layers.report, task, options.discontinuity, solution.statistics);
    solution.statistics.figures.insert(layers.figures.begin(), layers.figures.end());
    solution.interpolant = elements_of_layers(solution);
    return layers.report;
}

}  // namespace

DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points, const ShowLayers& show) {
    MeshTask task(stage, options, solution, stop);
    if (options.discontinuity.layers == true) return add_layers(stage, options, task, solution, stop, show);
    task.ask.safe_points = safe_points;
    DiscontinuityReport report;
    solution.discontinuity = make_discontinuity_mesh(stage, task.ask, report, stop);
    solution.interpolant = linear_elements(solution.discontinuity, solution.scene);
    record_mesh(report, task, options.discontinuity, solution.statistics);
    if (extensions().discontinuity) {
        const auto figures = extensions().discontinuity->figures(solution.discontinuity);
        solution.statistics.figures.insert(figures.begin(), figures.end());
    }
    return report;
}

SixNodeMesh single_discontinuity_mesh(const Stage& stage, const SolveOptions& options, const Solution& solution,
                                      const StopRequest& stop) {
    const MeshTask task(stage, options, solution, stop);
    DiscontinuityReport report;
    return make_discontinuity_mesh(stage, task.ask, report, stop);
}

}  // namespace exitance

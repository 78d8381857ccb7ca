#include "exitance/methods/light/discontinuity_light.hpp"

#include <algorithm>

#include "exitance/calibration/numbers.hpp"
#include "exitance/core/progress.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/methods/light/secondary_light.hpp"
#include "exitance/reconstruct/discontinuity/source_layers.hpp"

namespace exitance {
namespace {

ConicCurves conics_of(ThreeEdgeEvents asked) {
    return asked == ThreeEdgeEvents::on    ? ConicCurves::all
           : asked == ThreeEdgeEvents::off ? ConicCurves::none
                                           : ConicCurves::at_umbras;
}

/// Computes the layers. Returns false, and sets `report.interrupted`, if a request to stop leaves them unfinished.
bool add_layers(const Stage& stage, const DiscontinuityOptions& ask, Solution& solution, LayersReport& layers,
                DiscontinuityReport& report, const StopRequest& stop) {
    const Stopwatch watch;
    solution.layers = make_light_layers(stage, ask, layers, stop);
    report.direct_seconds = watch.seconds();
    report.interrupted = layers.interrupted;
    return !layers.interrupted;
}

/// Records the memory of the layers, and of the same meshes with winged edges.
void record_layers(Solution& solution, const LayersReport& layers) {
    std::map<std::string, double>& figures = solution.statistics.figures;
    const bool has_layers = !solution.layers.empty();
    figures["layer_bytes"] = static_cast<double>(solution.layers.memory_bytes());
    figures["winged_edge_bytes"] =
        static_cast<double>(has_layers ? layers.winged_edge_bytes : winged_edge_bytes(solution.discontinuity));
    if (!has_layers) return;
    figures["layers"] = static_cast<double>(solution.layers.sources.size());
    figures["layer_triangles"] = static_cast<double>(layers.triangles);
    figures["lit_layer_triangles"] = static_cast<double>(solution.layers.size());
}

}  // namespace

DiscontinuityReport add_discontinuity_mesh(const Stage& stage, const SolveOptions& options, Solution& solution,
                                           const StopRequest& stop, SafePoints* safe_points) {
    const ElementLocator locator(solution.indirect.tree, solution.scene.regions().size());
    DiscontinuityOptions ask{.error = options.error_interpolant.value_or(options.error_target()),
                             .direct_weight = Spectrum(1.0) - solution.direct_share,
                             .seed = options.seed,
                             .safe_points = safe_points};
    ask.largest_error = calibrated::largest_dm_error * ask.error;
    const DiscontinuityChoice& choice = options.discontinuity;
    if (choice.sources && options.bounces != 0)
        ask.secondary = secondary_sources(stage, solution, locator, *choice.sources, stop);
    const SecondaryLight secondary(stage, solution.indirect, locator, ask.secondary, stop);
    if (options.bounces != 0) ask.indirect = [&](RegionId r, const Point& p) { return secondary.at(r, p); };
    ask.conics = conics_of(choice.three_edges.value_or(ThreeEdgeEvents::automatic));
    ask.triangulation = choice.triangulation.value_or(TriangulationScheme::delaunay);
    ask.penumbra_first = choice.premesh == Premesh::penumbra_first;
    ask.premesh = choice.premesh == Premesh::coarse;
    ask.merges_volumes = choice.structure == OccluderStructure::merged;
    ask.by_orderings = choice.structure == OccluderStructure::bsp || ask.merges_volumes;
    ask.refined = choice.quality == MeshQuality::delaunay;
    ask.clough_tocher = choice.element == MeshElement::clough_tocher;
    DiscontinuityReport report;
    LayersReport layers;
    if (choice.layers == true && !add_layers(stage, ask, solution, layers, report, stop)) return report;
    solution.discontinuity = make_discontinuity_mesh(stage, ask, report, stop);
    report.error = std::max(report.error, layers.error);
    if (solution.discontinuity.empty()) solution.layers = {};
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
    record_layers(solution, layers);
    if (ask.by_orderings) {
        statistics.figures["plane_tests"] = static_cast<double>(report.plane_tests);
        statistics.figures["fragments"] = static_cast<double>(report.fragments);
    }
    if (statistics.relative_error_estimate && !report.interrupted)
        statistics.relative_error_estimate_interpolant = std::hypot(report.error, *statistics.relative_error_estimate);
    return report;
}

}  // namespace exitance

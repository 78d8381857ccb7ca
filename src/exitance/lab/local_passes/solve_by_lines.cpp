#include "exitance/lab/local_passes/solve_by_lines.hpp"

#include <fmt/format.h>

#include "exitance/calibration/numbers.hpp"
#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/lab/local_passes/local_passes.hpp"
#include "exitance/methods/light/light_functions.hpp"

namespace exitance {
namespace {

/// The delivered light on a coarse mesh, from which the certificate computes how errors propagate.
GlobalLight coarse_light(const Stage& stage, const ElementFunction& delivered, const SolveOptions& options) {
    GlobalLight out;
    out.tree =
        stage.make_elements(knobs_for_error(calibrated::interrupted_error, stage.lit_spaces(), options).solve_mesh);
    out.numbering = LeafNumbering(out.tree);
    const ElementLocator locator(delivered.tree, stage.scene.regions().size());
    for (const ElementId e : out.numbering.leaves) {
        const RegionId r = out.tree.region(e);
        out.indirect.push_back(delivered.at(locator.find(r, out.tree.patch(e).at(out.tree.centre(e)))));
        out.reflected.push_back(stage.scene.material(r).reflectance * out.indirect.back());
    }
    out.direct.resize(out.indirect.size());
    return out;
}

/// Adds dark elements for regions without any triangle that is wide enough.
ElementFunction on_all_regions(ElementFunction f, const Stage& stage) {
    Field<RegionId, std::uint8_t> has_light(stage.scene.regions().size(), 0);
    for (const ElementId root : f.tree.roots()) has_light[f.tree.region(root)] = 1;
    for (const Piece& piece : stage.pieces) {
        if (has_light[piece.region]) continue;
        const ElementId root = f.tree.add_root(piece.region, piece.patch);
        f.first_value.resize(f.tree.size());
        f.first_value[root] = static_cast<std::uint32_t>(f.values.size());
        for (int k = 0; k < piece.patch.corner_count(); ++k) f.add_value({});
    }
    return f;
}

DiscontinuityCounts counts_of(const SixNodeMesh& mesh, const LocalPassWork& work) {
    DiscontinuityCounts counts;
    for (const DiscontinuityCurve& c : mesh.curves)
        ++(c.order == CurveOrder::d0 ? counts.d0 : c.order == CurveOrder::d1 ? counts.d1 : counts.d2);
    for (const ShadowClass c : mesh.shadow)
        ++(c == ShadowClass::lit ? counts.lit : c == ShadowClass::penumbra ? counts.penumbra : counts.umbra);
    counts.triangles = mesh.size(), counts.mean_radius_ratio = work.radius_ratio;
    return counts;
}

void record(const LineHierarchy& hierarchy, const LocalPassWork& work, GlobalLight& light) {
    light.report.iterations = hierarchy.iterations(), light.report.residual = hierarchy.change();
    light.work.links = hierarchy.links().size();
    light.work.link_memory_bytes = light.work.links * sizeof(LineHierarchy::Link);
    light.work.rays = hierarchy.rays() + work.rays;
    light.work.form_factors = hierarchy.form_factors() + work.form_factors;
    PublishedLight& published = *light.published;
    published.elements = hierarchy.tree().size(), published.leaf_elements = hierarchy.leaf_count();
    published.figures = {{"local_pass_nodes", static_cast<double>(work.nodes)},
                         {"threshold", hierarchy.options().threshold},
                         {"min_area", hierarchy.options().min_area}};
}

/// Returns an error if the scene has too many polygons.
std::optional<Error> refusal(const Stage& stage) {
    if (stage.pieces.size() <= LineHierarchy::max_pieces) return {};
    return Error{ErrorCode::bad_input,
                 fmt::format("has {} convex polygons; --local-pass a to d examines all pairs and supports at most {}",
                             stage.pieces.size(), LineHierarchy::max_pieces),
                 stage.scene.file(), "--local-pass e has no such limit"};
}

}  // namespace

LineHierarchyOptions line_options(const SolveOptions& options, double error) {
    // Errors of constant elements fall with the square root of the least area and of the light that a link may carry.
    constexpr double share = 0.5;
    LineHierarchyOptions out;
    out.threshold = share * error * error;
    out.min_area = calibrated::min_line_area * error * error;
    out.rays = options.visibility_samples.value_or(out.rays);
    out.seed = options.seed;
    return out;
}

GlobalLight solve_by_lines(const MethodInput& input) {
    const Stage& stage = input.stage;
    const SolveOptions& options = input.options;
    const StopRequest& stop = input.stop;
    PublishedLight published{.irradiance = dark(stage), .refusal = refusal(stage)};
    if (published.refusal) return {.delivery = MethodDelivery::all_light, .published = std::move(published)};
    LineHierarchy hierarchy(stage, line_options(options, input.aim));
    const bool is_whole = hierarchy.solve(input.progress, stop);
    input.progress.phase("local pass");
    LocalPassWork work;
    const StopRequest go_on;  // not stopped: the light found in time is still evaluated
    if (!hierarchy.links().empty() || !stop.requested())
        published.mesh = run_local_pass(hierarchy, is_whole ? *options.local_pass : LocalPassRule::a, work, go_on);
    if (!published.mesh.empty()) {
        published.irradiance = on_all_regions(linear_elements(published.mesh, stage.scene), stage);
        published.counts = counts_of(published.mesh, work);
    }
    GlobalLight light = coarse_light(stage, published.irradiance, options);
    light.delivery = MethodDelivery::all_light;
    light.published = std::move(published);
    record(hierarchy, work, light);
    light.report.interrupted = !is_whole || stop.requested();
    light.report.converged = !light.report.interrupted;
    return light;
}

}  // namespace exitance

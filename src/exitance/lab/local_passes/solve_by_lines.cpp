#include "exitance/lab/local_passes/solve_by_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/phase_times.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/discontinuity/discontinuity_mesh.hpp"
#include "exitance/error/certificate.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/evaluate/quick_function.hpp"
#include "exitance/lab/local_passes/local_passes.hpp"
#include "exitance/methods/carried_light.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/solve/global_light.hpp"

namespace exitance {
namespace {

/// The delivered light on a coarse mesh, from which the certificate computes how errors propagate.
GlobalLight coarse_light(const Stage& stage, const ElementFunction& delivered, const SolveOptions& options) {
    GlobalLight out;
    out.tree =
        stage.make_elements(knobs_for_error(calibrated::interrupted_error, stage.lit_pieces(), options).solve_mesh);
    out.numbering = LeafNumbering(out.tree);
    const ElementLocator locator(delivered.tree, stage.scene.regions().size());
    for (const ElementId e : out.numbering.leaves) {
        const RegionId r = out.tree.region(e);
        out.indirect.push_back(delivered.at(locator.find(r, out.tree.patch(e).at(out.tree.centre(e)))));
        out.reflected.push_back(stage.scene.material(r).reflectance * out.indirect.back());
    }
    out.direct.resize(out.indirect.size());
    out.delivery = MethodDelivery::all_light;
    return out;
}

/// rho E of every leaf, which rays evaluate.
ElementFunction reflected_by(const ElementFunction& E, const Scene& scene) {
    ElementFunction out = E;
    for (const ElementId e : E.tree.leaves()) {
        const Spectrum& rho = scene.material(E.tree.region(e)).reflectance;
        for (int k = 0; k < E.tree.patch(e).corner_count(); ++k)
            for (std::size_t b = 0; b < bands; ++b)
                out.values[E.first_value[e] + static_cast<std::uint32_t>(k)][b] *= static_cast<float>(rho[b]);
    }
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

void certify(const Stage& stage, const SolveOptions& options, Solution& solution) {
    SolveStatistics& s = solution.statistics;
    const GlobalLight coarse = coarse_light(stage, solution.indirect, options);
    const ElementFunction reflected = reflected_by(solution.indirect, stage.scene);
    const QuickFunction b(reflected, stage.scene.regions().size());
    const SceneBodies bodies = find_bodies(stage.scene);
    CertificateOptions look{.error = options.error_target(), .seed = options.seed};
    look.direct_in_elements = true;
    look.bodies = &bodies;
    look.light_in = look.allowed_in = light_by_room(stage, coarse);
    Certifier certifier(stage, coarse, solution.indirect, b, look);
    Certificate found = certifier.look();
    certifier.look_at_bodies(found);
    certifier.tell_p99(found);
    s.relative_error_estimate = s.relative_error_estimate_interpolant = found.estimate;
    s.relative_error_bound = found.bound;
    s.relative_error_estimate_worst_room = found.largest();
    s.relative_error_estimate_worst_body = found.worst_body;
    s.error_p99 = found.p99;
    s.rooms = certifier.rooms(), s.bodies = certifier.bodies(), s.surface_errors = certifier.surface_errors();
    s.rays += found.rays;
}

void record(const LineHierarchy& hierarchy, const LocalPassWork& work, const SixNodeMesh& mesh, SolveStatistics& s) {
    s.elements = hierarchy.tree().size(), s.leaf_elements = hierarchy.leaf_count();
    s.links = hierarchy.links().size();
    s.link_memory_bytes = s.links * sizeof(LineHierarchy::Link);
    s.rays += hierarchy.rays() + work.rays;
    s.form_factors += hierarchy.form_factors() + work.form_factors;
    s.iterations = hierarchy.iterations(), s.residual = hierarchy.change();
    DiscontinuityCounts counts;
    for (const DiscontinuityCurve& c : mesh.curves)
        ++(c.order == CurveOrder::d0 ? counts.d0 : c.order == CurveOrder::d1 ? counts.d1 : counts.d2);
    for (const ShadowClass c : mesh.shadow)
        ++(c == ShadowClass::lit ? counts.lit : c == ShadowClass::penumbra ? counts.penumbra : counts.umbra);
    counts.triangles = mesh.size(), counts.mean_radius_ratio = work.radius_ratio;
    s.discontinuity = counts;
    s.figures["local_pass_nodes"] = static_cast<double>(work.nodes);
    s.figures["threshold"] = hierarchy.options().threshold;
    s.figures["min_area"] = hierarchy.options().min_area;
}

/// Runs both passes. Returns false if a stop left no new light.
bool pass(const Stage& stage, const SolveOptions& options, double error, Solution& solution, Progress& progress,
          const StopRequest& stop) {
    LineHierarchy hierarchy(stage, line_options(options, error));
    const bool whole = hierarchy.solve(progress, stop);
    if (!whole && !solution.discontinuity.empty()) return false;
    progress.phase("local pass");
    LocalPassWork work;
    SixNodeMesh mesh;
    const StopRequest go_on;  // not stopped: the light found in time is still evaluated
    if (!hierarchy.links().empty() || !stop.requested())
        mesh = run_local_pass(hierarchy, whole ? *options.local_pass : LocalPassRule::a, work, go_on);
    if (mesh.empty()) return whole;
    solution.interpolant = solution.indirect = on_all_regions(linear_elements(mesh, stage.scene), stage);
    record(hierarchy, work, mesh, solution.statistics);
    solution.discontinuity = std::move(mesh);
    return whole;
}

EnergyBalance balance(const Solution& solution, const Stage& stage) {
    DirectProjection none;
    for (const Piece& piece : stage.pieces) none.tree.add_root(piece.region, piece.patch);
    none.fit.resize(none.tree.size());
    return energy_balance(solution, none, stage);
}

}  // namespace

LineHierarchyOptions line_options(const SolveOptions& options, double error) {
    // Errors of constant elements fall with the square root of the least area and of the light that a link may carry.
    constexpr double share = 0.5;
    LineHierarchyOptions out;
    out.threshold = share * error * error;
    out.min_area = calibrated::least_line_area * error * error;
    out.rays = options.visibility_samples.value_or(out.rays);
    out.seed = options.seed;
    return out;
}

Result<Solution> solve_by_lines(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop) {
    if (!is_lit_by_diffuse_surfaces(scene))
        return Error{ErrorCode::bad_input, "has lights without extent, or that are not diffuse", scene.file(),
                     "--local-pass a to d carries light between diffuse polygons alone: e carries this light, too"};
    const Stopwatch watch;
    Solution solution{.scene = scene};
    PhaseTimes phases(progress, solution.statistics.seconds);
    Stage stage(solution.scene);
    if (stage.pieces.size() > LineHierarchy::most_pieces)
        return Error{
            ErrorCode::bad_input,
            fmt::format("has {} convex polygons; --local-pass a to d examines all pairs and supports at most {}",
                        stage.pieces.size(), LineHierarchy::most_pieces),
            scene.file(), "--local-pass e has no such limit"};
    stage.rooms = find_light_rooms(stage, options.seed, stop);
    SolveStatistics& s = solution.statistics;
    s.method = name_in(method_names, Method::discontinuity), s.basis = "quadratic";
    s.threads = threads(), s.schedule = name_in(schedule_names, schedule());
    s.surfaces = scene.surfaces().size();
    solution.direct_in_elements = true;
    solution.indirect = solution.interpolant = dark(stage);
    constexpr int max_attempts = 4;
    // The exported function is the solution, so the stricter of both requested errors applies.
    std::optional<double> demand = options.error_demand();
    if (options.error_interpolant) demand = std::min(*options.error_interpolant, demand.value_or(HUGE_VAL));
    double error = demand.value_or(default_error);
    for (int attempt = 1;; ++attempt) {
        const Stopwatch attempt_watch;
        const bool whole = pass(stage, options, error, solution, phases, stop);
        if (!whole || stop.requested()) {
            s.stopped_by = stop.interrupted() ? "interrupt" : "time limit";
            break;
        }
        phases.phase("certify");
        certify(stage, options, solution);
        const double found = std::max(*s.relative_error_estimate, s.relative_error_estimate_worst_room.value_or(0));
        progress.note(fmt::format("estimated error {:.2f}%, {:.2f}% in the worst room",
                                  100 * *s.relative_error_estimate, 100 * found));
        s.converged = !demand || found <= *demand;
        if (s.converged) break;
        // Halving the error takes about four times as many links and nodes.
        constexpr double cost_of_finer = 4, min_factor = 0.5;
        if (attempt == max_attempts || stop.seconds_left() < cost_of_finer * attempt_watch.seconds()) {
            s.stopped_by = attempt == max_attempts ? "iterations" : "time limit";
            break;
        }
        error *= std::max(min_factor, calibrated::part_aim * *demand / found);
    }
    phases.close();
    s.energy = balance(solution, stage);
    s.seconds[RunPart::total] = watch.seconds();
    s.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance

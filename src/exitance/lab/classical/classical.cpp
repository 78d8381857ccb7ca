#include "exitance/lab/classical/classical.hpp"

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/phase_times.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/gather/local_pass.hpp"
#include "exitance/lab/classical/classical_input.hpp"
#include "exitance/lab/classical/vertex_averages.hpp"
#include "exitance/methods/carried_light.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/solve_report.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {

ElementTree constant_mesh(const ClassicalInput& input) {
    input.progress.phase("mesh");
    const MeshSize size = input.knobs.solve_mesh;
    if (input.classical.mesh == MeshKind::uniform)
        return make_mesh(input.stage.pieces, input.stage.concave, {.edge = size.edge});
    return project_direct_light(input.stage,
                                {.mesh = size, .tolerance = input.knobs.direct_tolerance, .seed = input.options.seed},
                                input.stop)
        .tree;
}

std::vector<Spectrum> mean_direct_light(const ClassicalInput& input, const ElementTree& tree,
                                        std::span<const ElementId> leaves) {
    std::vector<Spectrum> out(leaves.size());
    parallel_ranges(leaves.size(), 16, [&](std::size_t first, std::size_t last) {
        DirectFitRoom room;
        for (std::size_t i = first; i < last; ++i)
            out[i] = fit_direct_light(input.stage, tree, leaves[i], 0, room).mean;
    });
    return out;
}

std::vector<Spectrum> exitances(const ClassicalInput& input, const ElementTree& tree,
                                std::span<const ElementId> leaves) {
    std::vector<Spectrum> out;
    for (ElementId e : leaves) out.push_back(input.material(tree, e).exitance);
    return out;
}

ElementFunction constant_function(const ElementTree& tree, std::span<const ElementId> leaves,
                                  std::span<const Spectrum> values) {
    ElementFunction out;
    out.tree = tree;
    out.first_value.resize(tree.size(), 0);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        out.first_value[leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < 4; ++corner) out.add_value(values[i]);
    }
    return out;
}

namespace {

HierarchyBasis basis_of(Method method, const SolveOptions& options) {
    if (method == Method::hierarchical) return HierarchyBasis::haar;
    switch (options.basis.value_or(BasisKind::multiwavelet2)) {
        case BasisKind::haar:
            return HierarchyBasis::haar;
        case BasisKind::flatlet2:
            return HierarchyBasis::flatlet2;
        case BasisKind::flatlet3:
            return HierarchyBasis::flatlet3;
        case BasisKind::multiwavelet3:
            return HierarchyBasis::multiwavelet3;
        default:
            return HierarchyBasis::multiwavelet2;
    }
}

std::string_view basis_name(Method method, const SolveOptions& options) {
    if (method == Method::hierarchical) return name_in(basis_names, BasisKind::haar);
    if (method == Method::wavelet) return name_in(basis_names, options.basis.value_or(BasisKind::multiwavelet2));
    return name_in(basis_names, BasisKind::constant);
}

Result<ClassicalLight> find_light(Method method, const ClassicalInput& input) {
    if (method == Method::matrix) return solve_classical_matrix(input);
    if (method == Method::progressive || method == Method::substructuring)
        return solve_classical_shooting(input, method == Method::substructuring);
    return solve_classical_links(input, basis_of(method, input.options));
}

/// Exact direct light on the leaves of a tree; zero if emitters' light is carried by the method.
DirectProjection direct_on(const Stage& stage, bool carried, const ElementTree& tree) {
    DirectProjection out{.tree = tree, .fit = Field<ElementId, DirectFit>(tree.size())};
    if (carried) return out;
    const std::vector<ElementId> leaves = tree.leaves();
    parallel_ranges(leaves.size(), 16, [&](std::size_t first, std::size_t last) {
        DirectFitRoom room;
        for (std::size_t i = first; i < last; ++i)
            out.fit[leaves[i]] = fit_direct_light(stage, tree, leaves[i], 0, room);
    });
    return out;
}

/// Mean reflected light, to which the gather's tolerances are relative, W/m^2.
double mean_reflected(const ClassicalInput& input, const ElementFunction& E, const DirectProjection& direct) {
    double flux = 0;
    for (ElementId e : E.tree.leaves()) {
        const Spectrum all = E.at({e, E.tree.centre(e)}) + direct.fit[e].mean;
        flux += E.tree.area(e) * mean(input.material(E.tree, e).reflectance * all);
    }
    return flux / input.stage.area;
}

/// The final gather: E = H b by rays, where b is the method's light, including that of emitters if it is carried.
ElementFunction gathered(const ClassicalInput& input, const ElementFunction& E, SolveStatistics& statistics) {
    input.progress.phase("gather");
    const DirectProjection direct = direct_on(input.stage, input.carries(), E.tree);
    const Knobs& knobs = input.knobs;
    const double scale = mean_reflected(input, E, direct);
    const Spectrum one(1.0), none;
    const DeliveredLight b(input.stage.scene, E, direct, input.carries() ? none : one, input.carries() ? one : none);
    LocalPass pass(input.stage, knobs.gather_mesh, input.options.seed);
    LocalPassReport report;
    ElementFunction out = pass.gather(b, true,
                                      {.rays = knobs.gather_rays,
                                       .light = scale,
                                       .noise = knobs.gather_noise * scale,
                                       .tolerance = knobs.gather_tolerance * scale,
                                       .curved = knobs.gather_curved,
                                       .relative_tolerance = knobs.gather_relative_tolerance},
                                      report, input.progress, input.stop);
    statistics.rays += report.rays;
    return out;
}

/// Returns all light on plain elements, for other programs: the method's light plus exact direct light, if separate.
ElementFunction with_direct(const ElementFunction& E, const DirectProjection& direct) {
    ElementFunction out;
    out.tree = E.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        const Patch& patch = out.tree.patch(e);
        for (int k = 0; k < 4; ++k)
            out.add_value(E.at({e, patch.corner_uv(std::min(k, patch.corner_count() - 1))}) +
                          direct.fit[e].corners[static_cast<std::size_t>(k)]);
    }
    return out;
}

// Statistics: seconds of real time and of all processors, from the start of the method to the end of gather and
// smoothing, without the time of writing snapshots.
constexpr const char* method_key = "method_seconds";
constexpr const char* processor_key = "processor_seconds";

void record(const ClassicalInput& input, Method method, const ClassicalLight& light, SolveStatistics& s,
            ClassicalFacts& facts) {
    s.method = name_in(method_names, method);
    s.basis = basis_name(method, input.options);
    s.threads = threads(), s.schedule = name_in(schedule_names, schedule());
    s.surfaces = input.stage.scene.surfaces().size();
    s.elements = light.elements, s.leaf_elements = light.leaf_elements;
    s.links = light.links, s.rays = light.rays, s.form_factors = light.form_factors;
    s.iterations = light.report.iterations, s.residual = light.report.residual;
    s.link_memory_bytes = light.link_memory_bytes;
    s.stopped_by = light.stopped_by;
    if (light.report.interrupted) {
        s.stopped_by = input.stop.interrupted() ? "interrupt" : "time limit";
    } else if (has_diverged(light.report)) {
        s.stopped_by = "divergence";
        s.warnings.emplace_back(divergence_warning);
    } else if (!light.report.converged && !input.options.max_iterations && s.stopped_by.empty()) {
        s.stopped_by = "iterations";
    }
    s.converged = s.stopped_by.empty();
    facts.direct = name_in(classical_direct_names, input.classical.direct.value_or(ClassicalDirect::apart));
    const bool linked = method == Method::hierarchical || method == Method::wavelet;
    facts.mesh_kind =
        name_in(mesh_kind_names, linked ? MeshKind::uniform : input.classical.mesh.value_or(MeshKind::aligned));
    facts.links_found_by = !linked                     ? "none"
                           : input.classical.oracle    ? name_in(classical_oracle_names, *input.classical.oracle)
                           : input.classical.threshold ? name_in(oracle_names, input.options.oracle)
                                                       : "leaves";
    facts.initial_links = light.initial_links;
    facts.coefficient_memory_bytes = light.coefficient_memory_bytes;
}

/// Intermediate solution of a running method.
Solution unfinished(const ClassicalInput& input, Method method, const Snapshots::Moment& moment) {
    const Stage& stage = input.stage;
    const ElementFunction& E = moment.light.irradiance;
    Solution out{.scene = stage.scene};
    out.direct_in_elements = input.carries();
    out.indirect = input.options.smoothing.value_or(false) ? averaged_at_vertices(E, 1e-6 * stage.scene.size()) : E;
    out.interpolant = with_direct(out.indirect, direct_on(stage, input.carries(), E.tree));
    ClassicalFacts facts;
    record(input, method, moment.light, out.statistics, facts);
    out.statistics.converged = false;
    out.statistics.seconds[RunPart::total] = moment.seconds;
    out.statistics.figures[method_key] = moment.seconds;
    out.statistics.figures[processor_key] = moment.processor_seconds;
    return out;
}

/// Returns an error if patches cannot emit or transmit the scene's light.
Result<void> check_emission(const Scene& scene, const ClassicalOptions& classical) {
    if (scene.surfaces().size() == 0)
        return Error{ErrorCode::usage, "classical forms need surfaces; the scene has none", "--method",
                     "leave out the options of classical forms"};
    if (scene.has_diffusing_panes())
        return Error{ErrorCode::usage,
                     "published forms carry light to one side of a surface, but the scene has diffusing panes",
                     "--method", "--method matrix without options of published forms supports them"};
    if (!classical.carried() || is_lit_by_diffuse_surfaces(scene)) return {};
    return Error{ErrorCode::usage, "carried light comes from diffuse emitters; the scene has others", "--direct",
                 "--direct apart supports all emitters"};
}

}  // namespace

Result<Solution> solve_classical(const Scene& scene, const SolveOptions& options, const ClassicalOptions& classical,
                                 Progress& progress, const StopRequest& stop, ClassicalFacts& facts,
                                 const SnapshotSink& sink) {
    const Result<Way> way = find_way({.options = options, .classical = classical}, Form::published);
    if (!way) return way.error();
    const Method method = way->method;
    if (const Result<void> fits = check_emission(scene, classical); !fits) return fits.error();
    if (options.threads > 0) set_threads(options.threads);
    set_schedule(options.schedule);
    const Stopwatch whole;
    Solution solution{.scene = scene};
    SolveStatistics& statistics = solution.statistics;
    PhaseTimes phases(progress, statistics.seconds);
    phases.phase("mesh");
    Stage stage(scene);
    const Knobs knobs = knobs_for_error(options.error_target(), stage.pieces, options);
    const ClassicalInput* watched = nullptr;
    Snapshots snapshots(classical.snapshots, [&](const Snapshots::Moment& moment) {
        return sink ? sink(unfinished(*watched, method, moment), moment.number) : Result<void>();
    });
    const ClassicalInput input{stage, options, classical, knobs, phases, stop, snapshots};
    watched = &input;
    Result<ClassicalLight> found = find_light(method, input);
    phases.close();
    if (!found) return found.error();
    ClassicalLight& light = *found;
    if (!snapshots.written()) return snapshots.written().error();
    double& solving = statistics.seconds[RunPart::solve];
    solving = std::max(0.0, solving - snapshots.writing());
    record(input, method, light, statistics, facts);
    solution.direct_in_elements = classical.carried();
    solution.indirect = std::move(light.irradiance);
    if (classical.gather.value_or(true) && stage.has_indirect_light() && !stop.requested())
        solution.indirect = gathered(input, solution.indirect, statistics);
    if (options.smoothing.value_or(false))
        solution.indirect = averaged_at_vertices(solution.indirect, 1e-6 * scene.size());
    statistics.figures[method_key] = snapshots.seconds();
    statistics.figures[processor_key] = snapshots.processor_seconds();
    phases.phase("reconstruct");
    const DirectProjection direct = direct_on(stage, input.carries(), solution.indirect.tree);
    solution.interpolant = with_direct(solution.indirect, direct);
    stage.rooms = find_light_rooms(stage, options.seed, stop);  // the energy balance needs rooms to find escaping light
    statistics.energy = energy_balance(solution, direct, stage);
    phases.close();
    statistics.seconds[RunPart::total] = whole.seconds() - snapshots.writing();
    statistics.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance

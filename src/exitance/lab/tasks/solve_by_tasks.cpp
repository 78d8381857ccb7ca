#include "exitance/lab/tasks/solve_by_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/phase_times.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/evaluate/energy.hpp"
#include "exitance/lab/tasks/interaction_forecast.hpp"
#include "exitance/lab/tasks/task_engine.hpp"
#include "exitance/methods/carried_light.hpp"
#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/light/smoothing.hpp"
#include "exitance/methods/solve_report.hpp"

namespace exitance {
namespace {

/// Converts the engine's quadtrees to a tree of elements with the light of its leaves: pieces first, then level by
/// level.
GlobalLight light_of(const TaskEngine& engine, const Stage& stage) {
    const PatchPool& patches = engine.patches();
    GlobalLight light;
    std::vector<std::uint32_t> patch_of;  // the patch of each element
    for (std::uint32_t root = 0; root < patches.root_count(); ++root) {
        light.tree.add_root(patches[root].region, patches[root].shape);
        patch_of.push_back(root);
    }
    for (std::size_t e = 0; e < patch_of.size(); ++e) {
        const std::uint32_t first = patches[patch_of[e]].first_child.load();
        if (first == TaskPatch::none) continue;
        light.tree.split(ElementId(e), Cut::both);
        for (std::uint32_t c = 0; c < 4; ++c) patch_of.push_back(first + c);
    }
    light.numbering = LeafNumbering(light.tree);
    for (ElementId e : light.numbering.leaves) {
        const TaskPatch& patch = patches[patch_of[e.value]];
        light.indirect.push_back(patch.irradiance);
        light.reflected.push_back(stage.scene.material(patch.region).reflectance * patch.irradiance);
    }
    light.direct.resize(light.indirect.size());
    light.delivery = MethodDelivery::all_light;
    light.work.elements_by_level = {};
    for (std::uint32_t p : patch_of) {
        light.work.elements_by_level.resize(
            std::max<std::size_t>(light.work.elements_by_level.size(), patches[p].level + 1u));
        ++light.work.elements_by_level[patches[p].level];
    }
    return light;
}

void record(const TaskEngine& engine, const TaskReport& report, const GlobalLight& light, const TaskOptions& asked,
            SolveStatistics& s) {
    const PatchPool& patches = engine.patches();
    s.elements = light.tree.size();
    s.leaf_elements = light.numbering.leaves.size();
    s.links = report.interactions;
    s.rays = report.rays;
    s.form_factors = report.form_factors;
    s.iterations = report.iterations;
    s.residual = report.change;
    s.link_memory_bytes = report.interactions * sizeof(Interaction);
    s.element_memory_bytes = patches.memory_bytes();
    s.elements_by_level = light.work.elements_by_level;
    s.figures["threshold"] = asked.threshold;
    s.figures["min_area"] = asked.min_area;
    s.figures["initial_links"] = static_cast<double>(report.initial_interactions);
    s.figures["predicted_links"] = predict_interactions(
        engine.visible_pairs(), [&](std::uint32_t root) { return patches[root].area; },
        [&](std::uint32_t root) { return max(engine.radiosity(root)); }, asked);
    s.figures["tasks"] = static_cast<double>(report.tasks);
    s.figures["stolen_tasks"] = static_cast<double>(report.stolen);
    // Processor time of all threads; parts of the solve's time.
    s.seconds[RunPart::visibility] = report.seconds[TaskGraph::vis],
    s.seconds[RunPart::form_factors] = report.seconds[TaskGraph::ff];
    for (std::size_t k = 0; k < TaskGraph::cost_names.size(); ++k)
        s.figures[std::string(TaskGraph::cost_names[k]) + "_seconds"] = report.seconds[k];
}

}  // namespace

TaskOptions task_options(const Scene& scene, const SolveOptions& options) {
    // Defaults: share of the power emitted in the brightest band; share of the area; F_eps; relative change of total
    // radiosity, which takes six or seven iterations in rooms of reflectance 0.5.
    constexpr double power_share = 1e-5, area_share = 2e-6, least_form_factor = 0.02, change = 0.01;
    constexpr std::size_t default_max_iterations = 100;
    TaskOptions out;
    out.by_power = options.oracle != LinkOracle::form_factor;
    Spectrum emitted;
    double area = 0;
    for (RegionId r : scene.regions().ids()) {
        emitted += scene.regions()[r].area * scene.material(r).exitance;
        area += scene.regions()[r].area;
    }
    out.threshold = options.threshold.value_or(out.by_power ? power_share * max(emitted) : least_form_factor);
    out.min_area = options.min_area.value_or(area_share * area);
    out.change = options.residual.value_or(change);
    out.max_iterations = options.max_iterations.value_or(default_max_iterations);
    out.rays = (options.visibility_samples.value_or(RayEnds::size) + RayEnds::size - 1) / RayEnds::size * RayEnds::size;
    out.triage = options.triage;
    out.schedule = options.schedule;
    out.threads = static_cast<std::size_t>(threads());
    out.seed = options.seed;
    return out;
}

Result<Solution> solve_by_tasks(const Scene& scene, const SolveOptions& options, Progress& progress,
                                const StopRequest& stop) {
    if (!is_lit_by_diffuse_surfaces(scene))
        return Error{ErrorCode::bad_input, "has lights without extent, or that are not diffuse", scene.file(),
                     "--task-engine carries light between diffuse patches alone: leave it out"};
    const Stopwatch watch;
    Solution solution{.scene = scene};
    SolveStatistics& statistics = solution.statistics;
    PhaseTimes phases(progress, statistics.seconds);
    phases.phase("mesh");
    Stage stage(solution.scene);

    phases.phase("tasks");
    TaskOptions asked = task_options(scene, options);
    asked.record = task_trace() != nullptr;
    TaskEngine engine(stage, asked);
    const TaskReport report = engine.run(phases, stop, task_trace() ? task_trace()->now() : 0);
    phases.phase("reconstruct");
    const GlobalLight light = light_of(engine, stage);
    solution.indirect = options.smoothing.value_or(false) ? smoothed_on_leaves(light, scene.regions().size())
                                                          : constant_on_leaves(light);
    solution.interpolant = solution.indirect;
    solution.direct_in_elements = true;
    statistics.method = "hierarchical", statistics.basis = "haar";
    statistics.threads = static_cast<int>(asked.threads);
    statistics.schedule = name_in(schedule_names, asked.schedule);
    statistics.surfaces = scene.surfaces().size();
    record(engine, report, light, asked, statistics);
    statistics.converged = report.converged || options.max_iterations;
    if (stop.requested()) statistics.stopped_by = stop.interrupted() ? "interrupt" : "time limit";
    if (!statistics.converged && statistics.stopped_by.empty()) statistics.stopped_by = "iterations";
    stage.rooms = find_light_rooms(stage, options.seed, stop);  // the energy balance needs rooms to find escaping light
    statistics.energy = energy_balance(solution, stage);
    if (task_trace()) task_trace()->add_graph(engine.take_graph());
    phases.close();
    statistics.seconds[RunPart::total] = watch.seconds();
    statistics.peak_memory_bytes = peak_memory_bytes();
    progress.note(
        fmt::format("{} tasks, {} of them stolen; total radiosity changed by {:.2g} in the last of {} iterations",
                    report.tasks, report.stolen, report.change, report.iterations));
    return solution;
}

}  // namespace exitance

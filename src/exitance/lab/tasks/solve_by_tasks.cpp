#include "exitance/lab/tasks/solve_by_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/lab/tasks/interaction_forecast.hpp"
#include "exitance/lab/tasks/task_engine.hpp"

namespace exitance {
namespace {

/// Converts the engine's quadtrees to a tree of elements with the light of its leaves: pieces first, then level by
/// level.
GlobalLight light_of(const TaskEngine& engine, const Stage& stage) {
    const PatchPool& patches = engine.patches();
    GlobalLight light;
    std::vector<std::uint32_t> patch_of;  // patch of each element
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

/// The light of an engine, with its counts.
GlobalLight light_with_counts(const TaskEngine& engine, const TaskReport& report, const Stage& stage,
                              const TaskOptions& asked) {
    GlobalLight light = light_of(engine, stage);
    light.report = {.iterations = report.iterations, .residual = report.change, .converged = report.converged};
    const PatchPool& patches = engine.patches();
    MethodWork& work = light.work;
    work.rays = report.rays, work.form_factors = report.form_factors;
    work.links = report.interactions, work.link_memory_bytes = report.interactions * sizeof(Interaction);
    work.element_memory_bytes = patches.memory_bytes();
    PublishedLight& published = light.published.emplace();
    published.elements = light.tree.size(), published.leaf_elements = light.numbering.leaves.size();
    auto& figures = published.figures;
    figures["threshold"] = asked.threshold;
    figures["min_area"] = asked.min_area;
    figures["initial_links"] = static_cast<double>(report.initial_interactions);
    figures["predicted_links"] = predict_interactions(
        engine.visible_pairs(), [&](std::uint32_t root) { return patches[root].area; },
        [&](std::uint32_t root) { return max(engine.radiosity(root)); }, asked);
    figures["tasks"] = static_cast<double>(report.tasks);
    figures["stolen_tasks"] = static_cast<double>(report.stolen);
    // Processor time of all threads.
    published.visibility_seconds = report.seconds[TaskGraph::vis];
    published.form_factor_seconds = report.seconds[TaskGraph::ff];
    for (std::size_t k = 0; k < TaskGraph::cost_names.size(); ++k)
        figures[std::string(TaskGraph::cost_names[k]) + "_seconds"] = report.seconds[k];
    return light;
}

}  // namespace

TaskOptions task_options(const Scene& scene, const SolveOptions& options) {
    // Defaults: share of the power emitted in the brightest band; share of the area; F_eps; relative change of total
    // radiosity, which takes six or seven iterations in rooms of reflectance 0.5.
    constexpr double power_share = 1e-5, area_share = 2e-6, min_form_factor = 0.02, change = 0.01;
    constexpr std::size_t default_max_iterations = 100;
    TaskOptions out;
    out.by_power = options.oracle != LinkOracle::form_factor;
    Spectrum emitted;
    double area = 0;
    for (RegionId r : scene.regions().ids()) {
        emitted += scene.regions()[r].area * scene.material(r).exitance;
        area += scene.regions()[r].area;
    }
    out.threshold = options.threshold.value_or(out.by_power ? power_share * max(emitted) : min_form_factor);
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

GlobalLight solve_by_tasks(const MethodInput& input) {
    input.progress.phase("tasks");
    TaskOptions asked = task_options(input.stage.scene, input.options);
    asked.record = task_trace() != nullptr;
    TaskEngine engine(input.stage, asked);
    SafePoints safe_points = input.safe_points;
    safe_points.resume([&](ArchiveReader& a) { engine.restore(a); });
    const auto end_iteration = [&](const TaskReport& so_far) {
        input.end_round([&] { return light_with_counts(engine, so_far, input.stage, asked); });
        safe_points.pass([&](ArchiveWriter& a) { engine.save(a); });
    };
    const TaskReport report =
        engine.run(input.progress, input.stop, task_trace() ? task_trace()->now() : 0, end_iteration);
    GlobalLight light = light_with_counts(engine, report, input.stage, asked);
    light.report.interrupted = input.stop.requested();
    if (task_trace()) task_trace()->add_graph(engine.take_graph());
    input.progress.note(
        fmt::format("{} tasks, {} of them stolen; total radiosity changed by {:.2g} in the last of {} iterations",
                    report.tasks, report.stolen, report.change, report.iterations));
    return light;
}

}  // namespace exitance

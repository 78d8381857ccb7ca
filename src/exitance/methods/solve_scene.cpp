#include "exitance/methods/solve_scene.hpp"

#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/methods/carried_light.hpp"
#include "exitance/methods/diffusing_panes.hpp"
#include "exitance/methods/extensions.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/solver/published_solver.hpp"
#include "exitance/methods/solver/standard_solver.hpp"
#include "exitance/scene/named_regions.hpp"

namespace exitance {
namespace {

/// Returns the solution of a scene without surfaces. All light at its points is direct and evaluated exactly.
Solution without_surfaces(Scene scene) {
    Solution out{.scene = std::move(scene)};
    out.bounces = 0;
    SolveStatistics& s = out.statistics;
    s.method = "direct", s.basis = "none";
    s.threads = threads(), s.schedule = name_in(schedule_names, schedule());
    s.converged = true;
    s.relative_error_estimate = s.relative_error_bound = s.error_p99 = 0;
    s.relative_error_estimate_interpolant = s.relative_error_estimate_worst_room = 0;
    s.peak_memory_bytes = peak_memory_bytes();
    return out;
}

}  // namespace

Result<Solution> solve_scene(Scene scene, const SolveOptions& options, Progress& progress, const StopRequest& stop,
                             CheckpointStore* checkpoints, const ShowLight& show) {
    if (options.threads > 0) set_threads(options.threads);
    set_schedule(options.schedule);
    if (scene.surfaces().size() == 0) return without_surfaces(std::move(scene));
    const Result<SolveOptions> settled = with_published_method(options);
    if (!settled) return settled.error();
    if (const Result<void> linked = check_extensions(*settled); !linked) return linked.error();
    if (const Result<void> passes = check_diffusing_panes(scene, *settled); !passes) return passes.error();
    if (const auto& lines = settled->discontinuity.lines)
        if (const Result<void> named = check_face_names(scene, lines->names, "--dm-lines"); !named)
            return named.error();
    if (const Result<void> carried = check_carried_light(scene, *settled); !carried) return carried.error();
    const Stopwatch watch;
    // Snapshots of the standard form are those of layers; they change nothing in its attempts.
    const ShowLight none, &interactive = settled->snapshots.any() ? none : show;
    const ShowLight& layers = settled->snapshots.any() ? show : none;
    Result<Solution> solution =
        form_of(*settled) == Form::standard
            ? StandardSolver(std::move(scene), *settled, progress, stop, checkpoints, interactive, layers).run()
            : PublishedSolver(std::move(scene), *settled, progress, stop, checkpoints, show).run();
    if (!solution) return solution;
    solution->statistics.seconds[RunPart::total] = watch.seconds();
    solution->statistics.peak_memory_bytes = peak_memory_bytes();
    return solution;
}

}  // namespace exitance

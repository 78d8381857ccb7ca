#pragma once

#include <optional>
#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/task_graph.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Measurements of schedules; all times in seconds. The first column of all tables is the scene.
struct ScheduleTables {
    /// Columns: `program` (engine: the tasks of 1995; production: an ordinary solve), `kind`, `schedule`, `machine`,
    /// `processors`, `seconds`, `speedup`, the seconds of all processors by use, and `limit`, the largest of these
    /// besides tasks. `measured` rows have real time. `busiest` ones have the processor time of the busiest thread of
    /// every iteration (the real time of an otherwise idle machine). `simulated` ones are results of
    /// `simulate_schedule`.
    Table runs;
    /// A recorded graph: its tasks, interactions found and predicted, the time of all its tasks, and the longest chain.
    Table graphs;
    Table iterations;  ///< Engine with one thread: tasks, interactions, seconds by kind, and the light, per iteration.
    /// Costs of 1993 that are not published: for every `slowness` of a processor, the lock (`lock_us`) with which one
    /// queue reaches 20 of 64 processors, as published, and the speed-ups of all schedules on that machine. Columns:
    /// `slowness`, `lock_us`, `schedule`, `processors`, `speedup`.
    Table calibration;
    Table curves;  ///< Figures 9 to 12 of [Vinod95], by `add_published_curves`.
    /// Pictures with the columns of `add_shape`: processors over time, and a tree of tasks.
    Table busy, tree;
    Table phases;  ///< Production solve with one thread: seconds, and seconds in parallel loops, per phase.
};

/// The engine's thresholds in W and m^2, as for `--threshold` and `--min-area`, and the number of runs of which the
/// fastest counts.
struct ScheduleStudy {
    std::optional<double> threshold, min_area;
    int repeats = 1;
    double error = 0.02;  ///< Requested error of the production solve.
};

/// Measures how schedules scale: on 1 and 2 threads, and simulated on 1 to 1024 processors from graphs recorded with
/// one thread, those of the task engine and those of the parallel loops of a solve.
void measure_schedules(const std::string& scene_name, const Scene& scene, const ScheduleStudy& study,
                       ScheduleTables& out, const StopRequest& stop);

/// Converts the loops of a run with one thread to a graph. Each loop is an iteration whose serial time after the
/// barrier lasts until the next loop; tasks create no tasks.
TaskGraph graph_of_loops(const TaskTrace& trace);

}  // namespace exitance

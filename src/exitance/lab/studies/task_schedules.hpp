#pragma once

#include <optional>
#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/task_graph.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/lab/study/table.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What is known of schedules; seconds everywhere. The first column of all tables is the scene.
struct ScheduleTables {
    /// `program` (engine: the tasks of 1995; production: a solve as users have it), `kind`, `schedule`, `machine`,
    /// `processors`, `seconds`, `speedup`, what the seconds of all processors went to, and the largest of these beside
    /// tasks, `limit`. `measured` rows have the
    /// wall clock, `busiest` ones the processor time of the busiest thread of every iteration (the wall clock of a
    /// machine with nothing else to do), `simulated` ones that of `simulate_schedule`.
    Table runs;
    /// A recorded graph: its tasks, interactions found and predicted, all its tasks' time, and the longest chain.
    Table graphs;
    Table iterations;  ///< Of the engine, by one thread: tasks, interactions, seconds by kind, the light after it.
    Table phases;      ///< Of a production solve, by one thread: seconds, and those in loops that are dealt out.
};

/// The engine's thresholds in W and m^2, as of `--threshold` and `--min-area`, and of how many runs the least is taken.
struct ScheduleStudy {
    std::optional<double> threshold, min_area;
    int repeats = 1;
    double error = 0.02;  ///< Asked of the production solve.
};

/// How schedules scale, on 1 and 2 threads, and replayed on 1 to 1024 processors from the graphs that one thread has
/// recorded: those of the task engine, and of the parallel loops of a solve.
void measure_schedules(const std::string& scene_name, const Scene& scene, const ScheduleStudy& study,
                       ScheduleTables& out, const StopRequest& stop);

/// The loops of a run by one thread as a graph: a loop is an iteration, behind whose barrier stands what is done until
/// the next one begins; tasks make no tasks.
TaskGraph graph_of_loops(const TaskTrace& trace);

}  // namespace exitance

#pragma once

#include <array>
#include <string>

#include "exitance/io/files/table.hpp"
#include "exitance/lab/tasks/schedule_simulator.hpp"

namespace exitance {

/// Graphs of one solve, by `Schedule`.
using GraphsBySchedule = std::array<TaskGraph, schedule_names.size()>;

/// Adds the curves of figures 9 to 12 of [Vinod95]: seconds and speed-up of every schedule on 1 to 64 processors of two
/// rings, and the ideal line of the schedule that is fastest on one processor. Columns: `scene`, `schedule` (or
/// "ideal"), `processors`, `seconds`, `speedup`.
void add_published_curves(const std::string& scene, const GraphsBySchedule& graphs, Table& out);

/// Draws busy and idle processors of two rings over time, by the columns of `add_shape`: blue where a processor works
/// on tasks, red where it works alone behind a barrier. Pauses below 1/400 of the run are not drawn.
void draw_busy_processors(const std::string& scene, const TaskGraph& graph, Schedule schedule, std::size_t processors,
                          Table& out);

/// Draws the largest tree of tasks that has at most 200 of them, or else the first 200 tasks of the smallest tree: a
/// dot for every task, the lighter the longer it takes, below the task that created it.
void draw_task_graph(const std::string& scene, const TaskGraph& graph, Table& out);

}  // namespace exitance

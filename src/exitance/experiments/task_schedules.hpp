#pragma once

#include <optional>
#include <string>

#include "exitance/core/progress.hpp"
#include "exitance/experiments/thesis/csv_text.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

inline constexpr const char* schedules_header =
    "scene,kind,schedule,machine,processors,seconds,speedup,task_seconds,queue_seconds,remote_seconds,idle_seconds,"
    "serial_seconds,stolen";
inline constexpr const char* task_graphs_header = "scene,schedule,tasks,critical_seconds,task_seconds";

/// How the schedules of the task engine scale: measured on 1 and 2 threads, and replayed on 1 to 1024 processors from
/// the graph that one thread has recorded. A row a schedule, machine and number of processors; seconds are the least of
/// so many repeats. `measured` rows have the engine's own wall time, `busiest` ones the processor time of the busiest
/// thread of every iteration (the wall clock of a machine with nothing else to do), `simulated` ones that of
/// `simulate_schedule`. Threshold in W, least area in m^2: as of `--threshold` and `--min-area`.
void measure_schedules(const std::string& scene_name, const Scene& scene, std::optional<double> threshold,
                       std::optional<double> min_area, int repeats, CsvText& out, CsvText& graphs,
                       const StopRequest& stop);

}  // namespace exitance

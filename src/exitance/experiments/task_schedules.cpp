#include "exitance/experiments/task_schedules.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "exitance/core/parallel.hpp"
#include "exitance/methods/tasks/solve_by_tasks.hpp"
#include "exitance/solve/tasks/schedule_simulator.hpp"
#include "exitance/solve/tasks/task_engine.hpp"

namespace exitance {
namespace {

struct Measured {
    double wall = std::numeric_limits<double>::infinity(), processor = wall;
    double busiest = wall;  ///< Processor time of the busiest thread, iteration by iteration, and what is serial.
    std::size_t stolen = 0;
};

/// What the wall clock would have told on a machine with nothing else to do.
double busiest_seconds(const TaskGraph& graph) {
    double sum = 0;
    for (const TaskGraph::Iteration& iteration : graph.iterations) {
        std::vector<double> of_worker(graph.workers, 0);
        for (std::size_t t = iteration.first_task; t < iteration.first_task + iteration.task_count; ++t)
            of_worker[graph.tasks[t].worker] += graph.tasks[t].cost();
        sum += *std::max_element(of_worker.begin(), of_worker.end()) + iteration.serial;
    }
    return sum;
}

/// The least of the repeats; the graph of the one with the least processor time, where it is wanted.
Measured measure(const Stage& stage, TaskOptions options, int repeats, TaskGraph* graph) {
    Measured out;
    Progress silent;
    const StopRequest stop;
    options.record = graph != nullptr;
    for (int i = 0; i < repeats; ++i) {
        TaskEngine engine(stage, options);
        const TaskReport report = engine.run(silent, stop);
        double processor = report.serial;
        for (double s : report.seconds) processor += s;
        if (options.record) out.busiest = std::min(out.busiest, busiest_seconds(engine.graph()));
        if (graph && processor < out.processor) *graph = engine.take_graph();
        out.processor = std::min(out.processor, processor);
        if (report.wall < out.wall) out.wall = report.wall, out.stolen = report.stolen;
    }
    return out;
}

}  // namespace

void measure_schedules(const std::string& scene_name, const Scene& scene, std::optional<double> threshold,
                       std::optional<double> min_area, int repeats, CsvText& out, CsvText& graphs,
                       const StopRequest& stop) {
    constexpr std::size_t most_processors = 1024;
    const Stage stage(scene);
    SolveOptions asked;
    asked.threshold = threshold, asked.min_area = min_area;
    TaskOptions options = task_options(scene, asked);
    for (const auto& [schedule, name] : schedule_names) {
        if (stop.requested()) return;
        options.schedule = schedule;
        TaskGraph graph;
        options.threads = 1;
        const Measured recorded = measure(stage, options, repeats, &graph);
        const Measured one = measure(stage, options, repeats, nullptr);
        options.threads = 2;
        const Measured two = measure(stage, options, repeats, nullptr);
        TaskGraph graph_of_two;
        const Measured shared = measure(stage, options, repeats, &graph_of_two);
        out.print("%s,measured,%s,,1,%.6f,1,%.6f,,,,,0\n", scene_name.c_str(), name.data(), one.wall, one.processor);
        out.print("%s,measured,%s,,2,%.6f,%.3f,%.6f,,,,,%zu\n", scene_name.c_str(), name.data(), two.wall,
                  one.wall / two.wall, two.processor, two.stolen);
        out.print("%s,busiest,%s,,1,%.6f,1,%.6f,,,,,0\n", scene_name.c_str(), name.data(), recorded.busiest,
                  recorded.processor);
        out.print("%s,busiest,%s,,2,%.6f,%.3f,%.6f,,,,,%zu\n", scene_name.c_str(), name.data(), shared.busiest,
                  recorded.busiest / shared.busiest, shared.processor, shared.stolen);
        for (const MachineModel& machine : machine_models) {
            const double alone = simulate_schedule(graph, schedule, 1, machine).seconds;
            for (std::size_t P = 1; P <= most_processors; P *= 2) {
                const SimulatedRun run = simulate_schedule(graph, schedule, P, machine);
                out.print("%s,simulated,%s,%s,%zu,%.6f,%.3f,%.6f,%.6f,%.6f,%.6f,%.6f,%zu\n", scene_name.c_str(),
                          name.data(), machine.name.data(), P, run.seconds, alone / run.seconds, run.tasks, run.queue,
                          run.remote, run.idle, run.serial, run.stolen);
            }
        }
        graphs.print("%s,%s,%zu,%.6f,%.6f\n", scene_name.c_str(), name.data(), graph.tasks.size(), critical_path(graph),
                     one.processor);
    }
}

}  // namespace exitance

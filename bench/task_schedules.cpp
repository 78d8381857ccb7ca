// How the schedules of the task engine scale: measured on 1 and 2 threads, and replayed on 1 to 1024 processors from
// the graph that one thread has recorded.
//
//     exitance-task-schedules SCENE.obj [-o F.csv] [--threshold W] [--min-area M2] [--repeats N]
//
// Wall seconds are the least of so many repeats. A row a schedule, machine and number of processors; `measured` rows
// have the engine's own time, `busiest` ones the processor time of the busiest thread of every iteration (the wall
// clock of a machine with nothing else to do), `simulated` ones that of `simulate_schedule`.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "exitance/core/parallel.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/methods/tasks/solve_by_tasks.hpp"
#include "exitance/solve/tasks/schedule_simulator.hpp"
#include "exitance/solve/tasks/task_engine.hpp"

namespace {

using namespace exitance;

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

int main(int argc, char** argv) {
    if (argc < 2) return std::fprintf(stderr, "usage: %s SCENE.obj [-o F.csv] [--threshold W] ...\n", argv[0]), 2;
    std::string output = "-";
    SolveOptions asked;
    int repeats = 3;
    for (int i = 2; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "-o")) output = argv[i + 1];
        if (!std::strcmp(argv[i], "--threshold")) asked.threshold = std::atof(argv[i + 1]);
        if (!std::strcmp(argv[i], "--min-area")) asked.min_area = std::atof(argv[i + 1]);
        if (!std::strcmp(argv[i], "--repeats")) repeats = std::atoi(argv[i + 1]);
    }
    const CheckedScene checked = load_scene({argv[1]}, {});
    if (!checked.scene) return std::fprintf(stderr, "%s\n", checked.scene.error().message.c_str()), 3;
    const Stage stage(*checked.scene);
    std::FILE* out = output == "-" ? stdout : std::fopen(output.c_str(), "w");
    if (!out) return std::fprintf(stderr, "cannot write %s\n", output.c_str()), 5;
    std::fprintf(out,
                 "kind,schedule,machine,processors,seconds,speedup,task_seconds,queue_seconds,remote_seconds,"
                 "idle_seconds,serial_seconds,stolen\n");
    TaskOptions options = task_options(*checked.scene, asked);
    for (const auto& [schedule, name] : schedule_names) {
        options.schedule = schedule;
        TaskGraph graph;
        options.threads = 1;
        const Measured recorded = measure(stage, options, repeats, &graph);
        const Measured one = measure(stage, options, repeats, nullptr);
        options.threads = 2;
        const Measured two = measure(stage, options, repeats, nullptr);
        TaskGraph graph_of_two;
        const Measured shared = measure(stage, options, repeats, &graph_of_two);
        std::fprintf(out, "measured,%s,,1,%.6f,1,%.6f,,,,,0\n", name.data(), one.wall, one.processor);
        std::fprintf(out, "measured,%s,,2,%.6f,%.3f,%.6f,,,,,%zu\n", name.data(), two.wall, one.wall / two.wall,
                     two.processor, two.stolen);
        std::fprintf(out, "busiest,%s,,1,%.6f,1,%.6f,,,,,0\n", name.data(), recorded.busiest, recorded.processor);
        std::fprintf(out, "busiest,%s,,2,%.6f,%.3f,%.6f,,,,,%zu\n", name.data(), shared.busiest,
                     recorded.busiest / shared.busiest, shared.processor, shared.stolen);
        for (const MachineModel& machine : machine_models) {
            const double alone = simulate_schedule(graph, schedule, 1, machine).seconds;
            for (std::size_t P = 1; P <= 1024; P *= 2) {
                const SimulatedRun run = simulate_schedule(graph, schedule, P, machine);
                std::fprintf(out, "simulated,%s,%s,%zu,%.6f,%.3f,%.6f,%.6f,%.6f,%.6f,%.6f,%zu\n", name.data(),
                             machine.name.data(), P, run.seconds, alone / run.seconds, run.tasks, run.queue, run.remote,
                             run.idle, run.serial, run.stolen);
            }
        }
        std::fprintf(stderr, "%s: %zu tasks, critical path %.4f s of %.4f s\n", name.data(), graph.tasks.size(),
                     critical_path(graph), one.processor);
    }
    if (out != stdout) std::fclose(out);
    return 0;
}

#include "exitance/lab/studies/task_schedules.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/studies/schedule_figures.hpp"
#include "exitance/lab/tasks/interaction_forecast.hpp"
#include "exitance/lab/tasks/schedule_simulator.hpp"
#include "exitance/lab/tasks/solve_by_tasks.hpp"
#include "exitance/lab/tasks/task_engine.hpp"
#include "exitance/methods/solve_scene.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_processors = 1024;

struct Measured {
    double wall = std::numeric_limits<double>::infinity(), processor = wall;
    double busiest = wall;  ///< Processor time of the busiest thread per iteration, plus serial time.
    std::size_t stolen = 0;
};

/// Columns that are common to all rows.
struct Rows {
    const std::string& scene;
    const char* program;
    std::string_view schedule;

    void begin(Table& table) const {
        table.add_row();
        table.set("scene", scene), table.set("program", program), table.set("schedule", std::string(schedule));
    }
    void add(Table& runs, const char* kind, std::size_t processors, double seconds, double of_one, double task_seconds,
             std::size_t stolen) const {
        begin(runs);
        runs.set("kind", kind), runs.set("processors", std::to_string(processors));
        runs.set("seconds", field(seconds)), runs.set("speedup", field(of_one / seconds));
        runs.set("task_seconds", field(task_seconds)), runs.set("stolen", std::to_string(stolen));
    }
};

/// Real time on an otherwise idle machine.
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

/// Number of interactions according to equations 6 and 7 of [Vinod95].
double predicted_interactions(const TaskEngine& engine, const TaskOptions& options) {
    return predict_interactions(
        engine.visible_pairs(), [&](std::uint32_t root) { return engine.patches()[root].area; },
        [&](std::uint32_t root) { return max(engine.radiosity(root)); }, options);
}

/// Replaces the times of tasks by those of another record of the same graph where they are shorter: what disturbed one
/// run did not disturb the other.
void take_least(const TaskGraph& other, TaskGraph& graph) {
    if (other.tasks.size() != graph.tasks.size() || other.iterations.size() != graph.iterations.size()) return;
    for (std::size_t t = 0; t < graph.tasks.size(); ++t)
        for (std::size_t k = 0; k < graph.tasks[t].seconds.size(); ++k)
            graph.tasks[t].seconds[k] = std::min(graph.tasks[t].seconds[k], other.tasks[t].seconds[k]);
    for (std::size_t i = 0; i < graph.iterations.size(); ++i)
        graph.iterations[i].serial = std::min(graph.iterations[i].serial, other.iterations[i].serial);
}

/// Graph with the least time of every task over all repeats, with its interactions.
struct Recorded {
    TaskGraph graph;
    std::size_t interactions = 0;
    double predicted = 0;
};
Measured measure(const Stage& stage, TaskOptions options, int repeats, Recorded* recorded) {
    Measured out;
    Progress silent;
    const StopRequest stop;
    options.record = recorded != nullptr;
    for (int i = 0; i < repeats; ++i) {
        TaskEngine engine(stage, options);
        const TaskReport report = engine.run(silent, stop);
        double processor = report.serial;
        for (double s : report.seconds) processor += s;
        if (options.record) out.busiest = std::min(out.busiest, busiest_seconds(engine.graph()));
        if (recorded && i == 0)
            *recorded = {engine.take_graph(), report.interactions, predicted_interactions(engine, options)};
        else if (recorded)
            take_least(engine.take_graph(), recorded->graph);
        out.processor = std::min(out.processor, processor);
        if (report.wall < out.wall) out.wall = report.wall, out.stolen = report.stolen;
    }
    return out;
}

/// The largest use of the processors' time besides tasks. After barriers, one processor works and all others are idle.
const char* limit_of(const SimulatedRun& run, std::size_t processors) {
    const double behind = run.serial * static_cast<double>(processors - 1);
    const std::pair<double, const char*> parts[] = {{run.idle - behind, "no task to do"},
                                                    {run.queue, "queues"},
                                                    {run.remote, "memory of others"},
                                                    {behind, "barriers"}};
    return std::max_element(std::begin(parts), std::end(parts))->second;
}

void add_replays(const TaskGraph& graph, Schedule schedule, const Rows& rows, Table& runs) {
    for (const MachineModel& machine : machine_models) {
        const double alone = simulate_schedule(graph, schedule, 1, machine).seconds;
        for (std::size_t P = 1; P <= max_processors; P *= 2) {
            const SimulatedRun run = simulate_schedule(graph, schedule, P, machine);
            rows.add(runs, "simulated", P, run.seconds, alone, run.tasks, run.stolen);
            runs.set("machine", std::string(machine.name)), runs.set("queue_seconds", field(run.queue));
            // With one processor the idle time is a difference of sums: only rounding.
            const double idle = P > 1 ? run.idle : 0;
            runs.set("remote_seconds", field(run.remote)), runs.set("idle_seconds", field(idle));
            runs.set("serial_seconds", field(run.serial)), runs.set("limit", P > 1 ? limit_of(run, P) : "");
        }
    }
}

/// Calibrates the lock of the rings on the published speed-up of one queue, and replays all schedules with it.
void add_calibration(const std::string& scene, const std::array<TaskGraph, schedule_names.size()>& graphs,
                     Table& calibration) {
    constexpr double published = 20;  // derived from [Vinod95]: dynamic flattens near 20 of 64 processors
    constexpr std::size_t processors = 64;
    const auto graph_of = [&](Schedule schedule) -> const TaskGraph& {
        return graphs[static_cast<std::size_t>(schedule)];
    };
    for (const int slowness : {100, 300, 1000, 3000}) {  // how many times a processor of today is faster
        MachineModel machine = two_rings;
        machine.slowness = slowness;
        const auto lock =
            flattening_lock(graph_of(Schedule::dynamic), Schedule::dynamic, processors, machine, published);
        if (!lock) continue;
        machine.queue = *lock;
        for (const auto& [schedule, name] : schedule_names) {
            const double alone = simulate_schedule(graph_of(schedule), schedule, 1, machine).seconds;
            for (const std::size_t P : {16, 32, 64}) {
                calibration.add_row();
                calibration.set("scene", scene), calibration.set("slowness", std::to_string(slowness));
                calibration.set("lock_us", field(1e6 * *lock)), calibration.set("schedule", std::string(name));
                calibration.set("processors", std::to_string(P));
                const double seconds = simulate_schedule(graph_of(schedule), schedule, P, machine).seconds;
                calibration.set("speedup", field(alone / seconds));
            }
        }
    }
}

double task_seconds(const TaskGraph& graph) {
    double sum = 0;
    for (const TaskGraph::Task& task : graph.tasks) sum += task.cost();
    return sum;
}

void add_graph(const TaskGraph& graph, const Rows& rows, Table& graphs) {
    rows.begin(graphs);
    graphs.set("tasks", std::to_string(graph.tasks.size()));
    graphs.set("iterations", std::to_string(graph.iterations.size()));
    graphs.set("task_seconds", field(task_seconds(graph)));
    graphs.set("critical_seconds", field(critical_path(graph)));
}

void add_iterations(const TaskGraph& graph, const Rows& rows, Table& iterations) {
    for (std::size_t i = 0; i < graph.iterations.size(); ++i) {
        const TaskGraph::Iteration& iteration = graph.iterations[i];
        std::array<double, 5> seconds{};
        std::size_t interactions = 0;
        for (std::size_t t = iteration.first_task; t < iteration.first_task + iteration.task_count; ++t) {
            interactions += graph.tasks[t].interactions;
            for (std::size_t k = 0; k < 5; ++k) seconds[k] += static_cast<double>(graph.tasks[t].seconds[k]);
        }
        rows.begin(iterations);
        iterations.set("iteration", std::to_string(i + 1));
        iterations.set("tasks", std::to_string(iteration.task_count));
        iterations.set("interactions", std::to_string(interactions));
        for (std::size_t k = 0; k < 5; ++k) iterations.set(TaskGraph::cost_names[k], field(seconds[k]));
        iterations.set("serial_seconds", field(iteration.serial));
        iterations.set("total_radiosity", field(iteration.total_radiosity));
    }
}

/// Trace and times of one complete solve, as the solver schedules it.
struct ProductionRun {
    TaskTrace trace;
    double seconds = 0, processor_seconds = 0;
};
void run_production(const Scene& scene, const ScheduleStudy& study, Schedule schedule, int threads_asked,
                    ProductionRun& run, const StopRequest& stop) {
    const int threads_before = threads();
    const Schedule schedule_before = exitance::schedule();
    set_threads(threads_asked), set_schedule(schedule);
    Progress silent;
    TracedProgress progress(silent, run.trace);
    SolveOptions options;
    options.error = study.error;
    set_task_trace(&run.trace);
    const std::clock_t processor = std::clock();
    const Stopwatch watch;
    static_cast<void>(solve_scene(scene, options, progress, stop));
    run.seconds = watch.seconds();
    run.processor_seconds = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
    run.trace.finish();
    set_task_trace(nullptr);
    set_threads(threads_before), set_schedule(schedule_before);
}

void add_phases(const TaskTrace& trace, const Rows& rows, Table& phases) {
    for (std::size_t i = 0; i < trace.phases().size(); ++i) {
        const TaskTrace::Phase& phase = trace.phases()[i];
        double dealt = 0;
        std::size_t loops = 0, tasks = 0;
        for (const TaskTrace::Loop& loop : trace.loops()) {
            if (loop.phase != i) continue;
            ++loops, tasks += loop.tasks.size();
            for (const TaskTrace::Task& task : loop.tasks) dealt += task.end - task.begin;
        }
        rows.begin(phases);
        phases.set("phase", phase.name), phases.set("seconds", field(phase.end - phase.begin));
        phases.set("dealt_out_seconds", field(dealt));
        phases.set("loops", std::to_string(loops)), phases.set("tasks", std::to_string(tasks));
    }
}

void measure_production(const std::string& scene_name, const Scene& scene, const ScheduleStudy& study,
                        ScheduleTables& out, const StopRequest& stop) {
    for (const auto& [schedule, name] : schedule_names) {
        const Rows rows{scene_name, "production", name};
        ProductionRun one, two;
        run_production(scene, study, schedule, 1, one, stop);
        run_production(scene, study, schedule, 2, two, stop);
        if (stop.requested()) return;
        rows.add(out.runs, "measured", 1, one.seconds, one.seconds, one.processor_seconds, 0);
        rows.add(out.runs, "measured", 2, two.seconds, one.seconds, two.processor_seconds, 0);
        const TaskGraph graph = graph_of_loops(one.trace);
        add_replays(graph, schedule, rows, out.runs);
        add_graph(graph, rows, out.graphs);
        if (schedule == Schedule::stealing) add_phases(one.trace, rows, out.phases);
    }
}

}  // namespace

TaskGraph graph_of_loops(const TaskTrace& trace) {
    TaskGraph graph;
    const std::vector<TaskTrace::Loop>& loops = trace.loops();
    const double end = trace.phases().empty() ? 0 : trace.phases().back().end;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        TaskGraph::Iteration iteration;
        iteration.begin = loops[i].begin, iteration.end = loops[i].end;
        iteration.first_task = graph.tasks.size(), iteration.task_count = loops[i].tasks.size();
        // Time before the first loop is serial, too.
        const double before = i == 0 ? loops[i].begin : 0;
        const double next = i + 1 < loops.size() ? loops[i + 1].begin : end;
        iteration.serial = before + std::max(0.0, next - loops[i].end);
        for (const TaskTrace::Task& task : loops[i].tasks) {
            TaskGraph::Task& out = graph.tasks.emplace_back();
            out.iteration = static_cast<std::uint32_t>(i), out.worker = static_cast<std::uint32_t>(task.worker);
            out.polygon = static_cast<std::uint32_t>(task.index), out.begin = task.begin, out.end = task.end;
            out.seconds[TaskGraph::init] = static_cast<float>(task.end - task.begin);
            graph.workers = std::max(graph.workers, task.worker + 1);
        }
        graph.iterations.push_back(iteration);
    }
    return graph;
}

void measure_schedules(const std::string& scene_name, const Scene& scene, const ScheduleStudy& study,
                       ScheduleTables& out, const StopRequest& stop) {
    const Stage stage(scene);
    SolveOptions asked;
    asked.threshold = study.threshold, asked.min_area = study.min_area;
    TaskOptions options = task_options(scene, asked);
    std::array<TaskGraph, schedule_names.size()> graphs;
    for (const auto& [schedule, name] : schedule_names) {
        if (stop.requested()) return;
        const Rows rows{scene_name, "engine", name};
        options.schedule = schedule;
        Recorded of_one, of_two;
        options.threads = 1;
        const Measured recorded = measure(stage, options, study.repeats, &of_one);
        const Measured one = measure(stage, options, study.repeats, nullptr);
        options.threads = 2;
        const Measured two = measure(stage, options, study.repeats, nullptr);
        const Measured shared = measure(stage, options, study.repeats, &of_two);
        rows.add(out.runs, "measured", 1, one.wall, one.wall, one.processor, 0);
        rows.add(out.runs, "measured", 2, two.wall, one.wall, two.processor, two.stolen);
        rows.add(out.runs, "busiest", 1, recorded.busiest, recorded.busiest, recorded.processor, 0);
        rows.add(out.runs, "busiest", 2, shared.busiest, recorded.busiest, shared.processor, shared.stolen);
        add_replays(of_one.graph, schedule, rows, out.runs);
        add_graph(of_one.graph, rows, out.graphs);
        out.graphs.set("interactions", std::to_string(of_one.interactions));
        out.graphs.set("predicted_interactions", field(of_one.predicted));
        out.graphs.set("predicted_over_found", field(of_one.predicted / static_cast<double>(of_one.interactions)));
        if (schedule == Schedule::stealing) add_iterations(of_one.graph, rows, out.iterations);
        graphs[static_cast<std::size_t>(schedule)] = std::move(of_one.graph);
    }
    add_calibration(scene_name, graphs, out.calibration);
    add_published_curves(scene_name, graphs, out.curves);
    constexpr std::size_t drawn_processors = 16;
    for (const auto& [schedule, name] : schedule_names)
        draw_busy_processors(scene_name, graphs[static_cast<std::size_t>(schedule)], schedule, drawn_processors,
                             out.busy);
    draw_task_graph(scene_name, graphs[static_cast<std::size_t>(Schedule::stealing)], out.tree);
    measure_production(scene_name, scene, study, out, stop);
}

}  // namespace exitance

#include "exitance/io/files/trace_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

/// Formats a time span on a line of the trace. `arguments` is appended after the id and begins with a comma.
std::string event(std::string_view name, const char* kind, std::size_t line, double begin, double end, std::uint64_t id,
                  std::string_view arguments) {
    constexpr double micro = 1e6;
    // Round both ends down, so that rounding does not make consecutive events overlap.
    const double from = std::floor(begin * micro * 1000) / 1000, to = std::floor(end * micro * 1000) / 1000;
    return fmt::format(
        ",\n{{\"name\":\"{}\",\"cat\":\"{}\",\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f},"
        "\"args\":{{\"id\":{}{}}}}}",
        name, kind, line, from, to - from, id, arguments);
}

std::string line_name(std::size_t line, std::string_view name) {
    return fmt::format(R"({{"name":"thread_name","ph":"M","pid":1,"tid":{},"args":{{"name":"{}"}}}})", line, name);
}

std::string describe(const TaskTrace::Loop& loop, const TaskTrace::Task& task) {
    const std::uint64_t first = task.index * loop.grain, last = std::min<std::uint64_t>(loop.count, first + loop.grain);
    std::string out = fmt::format(R"(,"parent":{},"first":{},"last":{})", loop.id, first, last);
    if (task.polygon != TaskTrace::none) out += fmt::format(R"(,"receiver_polygon":{})", task.polygon);
    if (task.first_source != TaskTrace::none)
        out +=
            fmt::format(R"(,"first_source_polygon":{},"last_source_polygon":{})", task.first_source, task.last_source);
    for (const TaskTrace::Touched& touched : task.touched)
        if (touched.what) out += fmt::format(R"(,"{}":{})", touched.what, touched.count);
    return out;
}

/// Writes iterations as loops, and their tasks. The parent of a task is the task that created it; that of a root task
/// is its iteration.
void write_graph(const TaskTrace& trace, const TaskGraph& graph, AtomicFile& file) {
    const std::uint64_t first_task = graph.id + graph.iterations.size();
    for (std::size_t i = 0; i < graph.iterations.size(); ++i) {
        const TaskGraph::Iteration& iteration = graph.iterations[i];
        file.write(event("iteration", "loop", 0, iteration.begin, iteration.end, graph.id + i,
                         fmt::format(R"(,"parent":{},"tasks":{},"total_radiosity":{:.9g},"serial":{:.3f})",
                                     trace.phases()[graph.phase].id, iteration.task_count, iteration.total_radiosity,
                                     1e6 * iteration.serial)));
    }
    for (std::size_t t = 0; t < graph.tasks.size(); ++t) {
        const TaskGraph::Task& task = graph.tasks[t];
        const bool is_root = task.maker == TaskGraph::none;
        std::string more =
            fmt::format(R"(,"parent":{},"iteration":{},"receiver_polygon":{},"level":{},"interactions":{})",
                        is_root ? graph.id + task.iteration : first_task + task.maker, task.iteration, task.polygon,
                        task.level, task.interactions);
        for (std::size_t k = 0; k < TaskGraph::cost_names.size(); ++k)
            more += fmt::format(R"(,"{}":{:.3f})", TaskGraph::cost_names[k], 1e6 * task.seconds[k]);
        file.write(event("patch", "task", task.worker + 1, task.begin, task.end, first_task + t, more));
    }
}

}  // namespace

Result<void> write_trace(const TaskTrace& trace, const std::string& path) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::size_t workers = 0;
    for (const TaskTrace::Loop& loop : trace.loops())
        for (const TaskTrace::Task& task : loop.tasks) workers = std::max(workers, task.worker + 1);
    for (const TaskGraph& graph : trace.graphs()) workers = std::max(workers, graph.workers);
    file->write(
        fmt::format("{{\"displayTimeUnit\":\"ms\",\"otherData\":{{\"schedule\":\"{}\",\"threads\":{}}},"
                    "\"traceEvents\":[\n{}",
                    schedule_names[static_cast<std::size_t>(schedule())].second, threads(), line_name(0, "phases")));
    for (std::size_t w = 0; w < workers; ++w) file->write(",\n" + line_name(w + 1, fmt::format("worker {}", w)));
    for (const TaskTrace::Phase& phase : trace.phases())
        file->write(event(phase.name, "phase", 0, phase.begin, phase.end, phase.id, ""));
    for (const TaskTrace::Loop& loop : trace.loops()) {
        file->write(event(loop.name, "loop", 0, loop.begin, loop.end, loop.id,
                          fmt::format(R"(,"parent":{},"tasks":{},"indices":{},"grain":{})",
                                      trace.phases()[loop.phase].id, loop.tasks.size(), loop.count, loop.grain)));
        for (const TaskTrace::Task& task : loop.tasks)
            file->write(event(loop.name, "task", task.worker + 1, task.begin, task.end, loop.id + 1 + task.index,
                              describe(loop, task)));
    }
    for (const TaskGraph& graph : trace.graphs()) write_graph(trace, graph, *file);
    file->write("\n]}\n");
    return file->commit();
}

}  // namespace exitance

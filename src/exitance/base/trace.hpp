#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/schedule.hpp"
#include "exitance/base/task_graph.hpp"

namespace exitance {

/// Record of the parallel loops of a run, for studies of schedules: phases, their loops, and the tasks of the loops.
/// Phases do not overlap, nor do loops, nor the tasks of one worker. Times in seconds since construction.
class TaskTrace {
  public:
    static constexpr std::uint64_t none = ~std::uint64_t(0);

    /// A kind of data that a task accessed, and how much of it.
    struct Touched {
        const char* what = nullptr;
        std::uint64_t count = 0;
    };
    struct Task {
        std::uint64_t index = 0;  ///< Index of the task in its loop.
        std::size_t worker = 0;
        double begin = 0, end = 0;
        std::uint64_t polygon = none;                        ///< Receiving polygon that the task belongs to, if known.
        std::uint64_t first_source = none, last_source = 0;  ///< Range of the polygons that the task reads, if known.
        std::array<Touched, 6> touched{};
    };
    struct Loop {
        std::string name;
        std::uint64_t id = 0;              ///< Id of the loop; its tasks have the ids that follow.
        std::size_t phase = 0;             ///< Index into phases().
        std::size_t count = 0, grain = 0;  ///< Number of indices in the loop, and per task.
        double begin = 0, end = 0;
        std::vector<Task> tasks;  ///< Sorted by worker, then by time.
    };
    struct Phase {
        std::string name;
        std::uint64_t id = 0;
        double begin = 0, end = 0;
    };

    TaskTrace();

    /// Ends the current phase and begins another. Called by the thread that drives the run.
    void begin_phase(std::string_view name);
    void finish();

    const std::vector<Phase>& phases() const { return phases_; }
    const std::vector<Loop>& loops() const { return loops_; }

    /// Called by parallel loops before and after their `tasks` tasks.
    Loop begin_loop(const char* name, std::size_t count, std::size_t grain, std::size_t tasks);
    void end_loop(Loop loop);
    /// Adds the record of an engine whose tasks create tasks. Its times must count from the start of this trace.
    void add_graph(TaskGraph graph);
    const std::vector<TaskGraph>& graphs() const { return graphs_; }
    double now() const { return watch_.seconds(); }

  private:
    Stopwatch watch_;
    std::vector<Phase> phases_;
    std::vector<Loop> loops_;
    std::vector<TaskGraph> graphs_;
    std::uint64_t next_id_ = 0;
};

/// Sets where parallel loops record their tasks from now on; null (the default): they record nothing. The trace must
/// outlive its use.
void set_task_trace(TaskTrace* trace);
TaskTrace* task_trace();

/// Forwards progress and records the phases in a trace.
class TracedProgress final : public Progress {
  public:
    TracedProgress(Progress& inner, TaskTrace& trace) : inner_(inner), trace_(trace) {}
    void phase(std::string_view name) override { trace_.begin_phase(name), inner_.phase(name); }
    void advance(double fraction, std::string_view detail) override { inner_.advance(fraction, detail); }
    void note(std::string_view message) override { inner_.note(message); }
    void warn(std::string_view message) override { inner_.warn(message); }

  private:
    Progress& inner_;
    TaskTrace& trace_;
};

namespace detail {
/// Record of the task that this thread is running; null outside of tasks and without a trace.
inline thread_local TaskTrace::Task* traced_task = nullptr;
}  // namespace detail

/// Adds `count` to the number of accesses of the current task to the data named `what`; a task records at most six
/// kinds. `what` must be a string of static lifetime. Does nothing outside of tasks and without a trace.
inline void note_touched(const char* what, std::uint64_t count) {
    if (!detail::traced_task) return;
    for (TaskTrace::Touched& touched : detail::traced_task->touched) {
        if (touched.what != nullptr && touched.what != what) continue;
        touched.what = what;
        touched.count += count;
        return;
    }
}

/// Records that the current task reads from this polygon. Does nothing outside of tasks and without a trace.
inline void note_source(std::uint64_t polygon) {
    if (!detail::traced_task) return;
    detail::traced_task->first_source = std::min(detail::traced_task->first_source, polygon);
    detail::traced_task->last_source = std::max(detail::traced_task->last_source, polygon);
}

}  // namespace exitance

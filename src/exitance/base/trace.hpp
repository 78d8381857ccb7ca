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

/// What the parallel loops of a run did, for studies of schedules: phases, their loops, and the loops' tasks. Phases
/// and loops follow one another; the tasks of one worker do, too. Times in seconds since the trace was made.
class TaskTrace {
  public:
    static constexpr std::uint64_t none = ~std::uint64_t(0);

    /// Something a task has touched, and how many or how much of it.
    struct Touched {
        const char* what = nullptr;
        std::uint64_t count = 0;
    };
    struct Task {
        std::uint64_t index = 0;  ///< In its loop.
        std::size_t worker = 0;
        double begin = 0, end = 0;
        std::uint64_t polygon = none;                        ///< That it belongs to, where known: the receiver.
        std::uint64_t first_source = none, last_source = 0;  ///< Polygons that it reads from, where known.
        std::array<Touched, 6> touched{};
    };
    struct Loop {
        std::string name;
        std::uint64_t id = 0;              ///< Its tasks have the ids that follow.
        std::size_t phase = 0;             ///< In phases().
        std::size_t count = 0, grain = 0;  ///< Indices, and of one task.
        double begin = 0, end = 0;
        std::vector<Task> tasks;  ///< By worker, then by time.
    };
    struct Phase {
        std::string name;
        std::uint64_t id = 0;
        double begin = 0, end = 0;
    };

    TaskTrace();

    /// The thread that drives the run says which phase begins; the one before it ends.
    void begin_phase(std::string_view name);
    void finish();

    const std::vector<Phase>& phases() const { return phases_; }
    const std::vector<Loop>& loops() const { return loops_; }

    /// For parallel loops: `tasks` of them are to begin, or have ended.
    Loop begin_loop(const char* name, std::size_t count, std::size_t grain, std::size_t tasks);
    void end_loop(Loop loop);
    /// Of an engine whose tasks make tasks; its times count from this trace's beginning.
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

/// Where parallel loops record their tasks from now on; null (as at first): nowhere. The trace must outlive that.
void set_task_trace(TaskTrace* trace);
TaskTrace* task_trace();

/// Tells a trace of the phases that pass by.
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
/// The task that this thread is in, as it is recorded; null outside, and without a trace.
inline thread_local TaskTrace::Task* traced_task = nullptr;
}  // namespace detail

/// The present task touches so many of `what`, a string that lives on: summed up over the task, six kinds at most.
/// Outside of tasks, and without a trace, nothing happens.
inline void note_touched(const char* what, std::uint64_t count) {
    if (!detail::traced_task) return;
    for (TaskTrace::Touched& touched : detail::traced_task->touched) {
        if (touched.what != nullptr && touched.what != what) continue;
        touched.what = what;
        touched.count += count;
        return;
    }
}

/// The present task reads from this polygon, likewise.
inline void note_source(std::uint64_t polygon) {
    if (!detail::traced_task) return;
    detail::traced_task->first_source = std::min(detail::traced_task->first_source, polygon);
    detail::traced_task->last_source = std::max(detail::traced_task->last_source, polygon);
}

}  // namespace exitance

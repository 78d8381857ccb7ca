#include <algorithm>
#include <atomic>
#include <utility>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/base/workers.hpp"

namespace exitance {
namespace {

Schedule current_schedule = Schedule::stealing;

/// Memory order of a loop: everything before the loop happens before its workers, and all of its workers before
/// everything after it. oneTBB guarantees this; the atomics repeat it for the thread sanitizer, which cannot see into a
/// library built without it.
class ForkAndJoin {
  public:
    ForkAndJoin() { begun_.store(true, std::memory_order_release); }
    void begin_worker() const { (void)begun_.load(std::memory_order_acquire); }
    void end_worker() { ended_.fetch_add(1, std::memory_order_release); }
    void join() const { (void)ended_.load(std::memory_order_acquire); }

  private:
    std::atomic<bool> begun_;
    std::atomic<std::size_t> ended_{0};
};

/// Runs the ranges of one loop.
class Loop {
  public:
    Loop(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
         const Work& work)
        : count_(count), grain_(grain), body_(body), work_(work) {}

    void run() {
        // Nested loops are not recorded: their time belongs to the enclosing task.
        TaskTrace* const trace = detail::traced_task ? nullptr : task_trace();
        if (!trace) return run_tasks();
        TaskTrace::Loop record = trace->begin_loop(work_.name, count_, grain_, tasks());
        records_.resize(workers());
        trace_ = trace;
        run_tasks();
        for (std::vector<TaskTrace::Task>& tasks : records_)
            record.tasks.insert(record.tasks.end(), tasks.begin(), tasks.end());
        trace->end_loop(std::move(record));
    }

  private:
    std::size_t tasks() const { return (count_ + grain_ - 1) / grain_; }
    std::size_t workers() const { return std::min(tasks(), static_cast<std::size_t>(threads())); }

    void run_tasks() {
        if (workers() == 1) {
            for (std::size_t task = 0; task < tasks(); ++task) run_task(task, 0);
            return;
        }
        std::vector<std::uint32_t> homes;
        if (work_.by_polygon && current_schedule != Schedule::dynamic) {
            homes.resize(tasks());
            for (std::size_t t = 0; t < homes.size(); ++t)
                homes[t] = static_cast<std::uint32_t>(work_.polygon_of(t * grain_));
        }
        Team team{*this, TaskQueues(current_schedule, tasks(), workers(), homes)};
        run_workers(workers(), work, &team);
        team.order.join();
    }

    struct Team {
        Loop& loop;
        TaskQueues queues;
        ForkAndJoin order = {};
    };
    static void work(void* pointer, std::size_t worker) {
        Team& team = *static_cast<Team*>(pointer);
        team.order.begin_worker();
        for (std::size_t task; (task = team.queues.next(worker)) != TaskQueues::none;) team.loop.run_task(task, worker);
        team.order.end_worker();
    }

    void run_task(std::size_t task, std::size_t worker) {
        const std::size_t first = task * grain_, last = std::min(count_, first + grain_);
        if (!trace_) return body_(first, last);
        TaskTrace::Task record{.index = task, .worker = worker, .begin = trace_->now()};
        if (work_.polygon_of) record.polygon = work_.polygon_of(first);
        TaskTrace::Task* const outer = std::exchange(detail::traced_task, &record);
        body_(first, last);
        detail::traced_task = outer;
        record.end = trace_->now();
        records_[worker].push_back(record);
    }

    std::size_t count_, grain_;
    const std::function<void(std::size_t, std::size_t)>& body_;
    const Work& work_;
    TaskTrace* trace_ = nullptr;
    std::vector<std::vector<TaskTrace::Task>> records_;  ///< Recorded tasks of each worker.
};

}  // namespace

void set_schedule(Schedule schedule) {
    current_schedule = schedule;
}

Schedule schedule() {
    return current_schedule;
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                     const Work& work) {
    if (count > 0) Loop(count, grain, body, work).run();
}

}  // namespace exitance

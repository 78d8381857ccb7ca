#include "exitance/lab/tasks/schedule_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <queue>
#include <set>
#include <utility>
#include <vector>

namespace exitance {
namespace {

/// Replay of one iteration, whose tasks are [first, first + count) of the graph.
class Replay {
  public:
    Replay(const TaskGraph& graph, const TaskGraph::Iteration& iteration, Schedule schedule, std::size_t processors,
           const MachineModel& machine, SimulatedRun& run, std::vector<BusyInterval>* busy)
        : graph_(graph),
          first_(iteration.first_task),
          children_(iteration.task_count),
          schedule_(schedule),
          processors_(processors),
          machine_(machine),
          run_(run),
          busy_(busy),
          begun_at_(run.seconds),
          queues_(schedule == Schedule::dynamic ? 1 : processors),
          free_at_(queues_.size(), 0),
          runner_(iteration.task_count, none),
          running_(processors, none) {
        for (std::size_t t = first_; t < first_ + iteration.task_count; ++t) {
            const TaskGraph::Task& task = graph.tasks[t];
            if (task.maker == TaskGraph::none)
                add_last(task.polygon % queues_.size(), t);
            else
                children_[task.maker - first_].push_back(t);
        }
    }

    /// Time at which the last task ends, counted from 0.
    double run() {
        for (std::size_t p = 0; p < processors_; ++p) events_.push({0, p});
        double end = 0;
        while (!events_.empty()) {
            const auto [now, p] = events_.top();
            events_.pop();
            if (running_[p] != none) end = std::max(end, push_made(now, p));
            take_next(std::max(now, push_done_), p);
            push_done_ = 0;
        }
        return end;
    }

  private:
    static constexpr std::size_t none = ~std::size_t(0);
    using Event = std::pair<double, std::size_t>;  ///< Time, and the processor that becomes free.

    void add_last(std::size_t queue, std::size_t task) {
        if (queues_[queue].empty()) filled_.insert(queue);
        queues_[queue].push_back(task);
    }
    void add_first(std::size_t queue, std::size_t task) {
        if (queues_[queue].empty()) filled_.insert(queue);
        queues_[queue].push_front(task);
    }
    std::size_t take(std::size_t queue, bool head) {
        std::deque<std::size_t>& tasks = queues_[queue];
        const std::size_t task = head ? tasks.front() : tasks.back();
        head ? tasks.pop_front() : tasks.pop_back();
        if (tasks.empty()) filled_.erase(queue);
        return task;
    }
    /// Waits for a queue's lock and uses the queue. Returns the time at which this processor is done with it.
    double at_queue(std::size_t queue, double now) {
        const double begin = std::max(now, free_at_[queue]);
        free_at_[queue] = begin + machine_.queue;
        run_.queue += free_at_[queue] - now;
        return free_at_[queue];
    }

    /// Pushes the tasks created by the task that has ended, and wakes processors that wait for them. Returns the time
    /// at which they are available.
    double push_made(double now, std::size_t p) {
        const std::vector<std::size_t>& made = children_[std::exchange(running_[p], none) - first_];
        if (made.empty()) return push_done_ = now;
        const std::size_t queue = schedule_ == Schedule::dynamic ? 0 : p;
        push_done_ = at_queue(queue, now);
        if (schedule_ == Schedule::stealing)
            for (std::size_t i = made.size(); i-- > 0;) add_first(queue, made[i]);
        else
            for (std::size_t t : made) add_last(queue, t);
        // One waiting processor per new task tries again.
        if (schedule_ != Schedule::fixed)
            for (std::size_t i = 0; i < made.size() && !waiting_.empty(); ++i) {
                const auto [since, waiter] = waiting_.front();
                waiting_.pop_front();
                events_.push({std::max(since, push_done_), waiter});
            }
        return push_done_;
    }

    void take_next(double now, std::size_t p) {
        const std::size_t own = schedule_ == Schedule::dynamic ? 0 : p;
        if (!queues_[own].empty()) return start(take(own, true), at_queue(own, now), p, false);
        if (schedule_ == Schedule::stealing && !filled_.empty()) {
            auto victim = filled_.upper_bound(p);
            if (victim == filled_.end()) victim = filled_.begin();
            const std::size_t queue = *victim, probes = (queue + processors_ - p) % processors_;
            const double search = static_cast<double>(probes) * machine_.probe + machine_.steal;
            run_.queue += search;
            ++run_.stolen;
            return start(take(queue, false), at_queue(queue, now + search), p, true);
        }
        waiting_.push_back({now, p});
    }

    void start(std::size_t t, double now, std::size_t p, bool is_stolen) {
        const TaskGraph::Task& task = graph_.tasks[t];
        const double P = static_cast<double>(processors_), cost = machine_.slowness * task.cost();
        const double outside = processors_ > machine_.ring ? 1 - static_cast<double>(machine_.ring) / P : 0;
        const double line = (1 - outside) * machine_.near + outside * machine_.far;
        const bool is_made_elsewhere = task.maker != TaskGraph::none && runner_[task.maker - first_] != p;
        const double remote = (1 - 1 / P + (is_stolen || is_made_elsewhere ? 1 : 0)) * task.interactions * line;
        runner_[t - first_] = p;
        run_.tasks += cost;
        run_.remote += remote;
        running_[p] = t;
        events_.push({now + cost + remote, p});
        if (busy_) busy_->push_back({p, begun_at_ + now, begun_at_ + now + cost + remote});
    }

    const TaskGraph& graph_;
    std::size_t first_;
    std::vector<std::vector<std::size_t>> children_;
    Schedule schedule_;
    std::size_t processors_;
    const MachineModel& machine_;
    SimulatedRun& run_;
    std::vector<BusyInterval>* busy_;
    double begun_at_;  ///< Time of the run at which this iteration begins, seconds.
    std::vector<std::deque<std::size_t>> queues_;
    std::set<std::size_t> filled_;     ///< Queues that are not empty.
    std::vector<double> free_at_;      ///< Time at which each queue's lock becomes free.
    std::vector<std::size_t> runner_;  ///< Processor that ran each task of the iteration.
    std::vector<std::size_t> running_;
    std::deque<Event> waiting_;
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    double push_done_ = 0;
};

}  // namespace

SimulatedRun simulate_schedule(const TaskGraph& graph, Schedule schedule, std::size_t processors,
                               const MachineModel& machine, std::vector<BusyInterval>* busy) {
    SimulatedRun run;
    for (const TaskGraph::Iteration& iteration : graph.iterations) {
        run.seconds += Replay(graph, iteration, schedule, processors, machine, run, busy).run();
        const double serial = machine.slowness * iteration.serial;
        if (busy) busy->push_back({0, run.seconds, run.seconds + serial, true});
        run.serial += serial, run.seconds += serial;
    }
    const double all = run.seconds * static_cast<double>(processors);
    run.idle = all - run.tasks - run.queue - run.remote - run.serial;
    return run;
}

std::optional<double> flattening_lock(const TaskGraph& graph, Schedule schedule, std::size_t processors,
                                      MachineModel machine, double speedup) {
    const auto speedup_with = [&](double lock) {
        machine.queue = lock;
        return simulate_schedule(graph, schedule, 1, machine).seconds /
               simulate_schedule(graph, schedule, processors, machine).seconds;
    };
    constexpr double shortest = 1e-9, longest = 1;  // seconds; derived from a processor's cycle and the longest task
    if (speedup_with(0) < speedup || speedup_with(longest) > speedup) return std::nullopt;
    double low = shortest, high = longest;
    constexpr double accuracy = 1.01;  // relative; derived from how well published curves can be read
    while (high > accuracy * low) {
        const double middle = std::sqrt(low * high);
        (speedup_with(middle) > speedup ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

double critical_path(const TaskGraph& graph) {
    double sum = 0;
    std::vector<double> reached(graph.tasks.size(), 0);
    for (const TaskGraph::Iteration& iteration : graph.iterations) {
        double longest = 0;
        for (std::size_t t = iteration.first_task; t < iteration.first_task + iteration.task_count; ++t) {
            const TaskGraph::Task& task = graph.tasks[t];
            reached[t] = task.cost() + (task.maker == TaskGraph::none ? 0 : reached[task.maker]);
            longest = std::max(longest, reached[t]);
        }
        sum += longest + iteration.serial;
    }
    return sum;
}

}  // namespace exitance

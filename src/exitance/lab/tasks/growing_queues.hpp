#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "exitance/base/schedule.hpp"

namespace exitance {

/// A patch whose list is to be processed.
struct PatchTask {
    std::uint32_t patch = 0;
    /// Patch whose task created this one; none for the first tasks of an iteration.
    std::uint32_t maker = 0xffffffffu;
};

/// Queues of tasks that create further tasks. Source: the three schemes of [Vinod95].
///
/// static    a worker's tasks and those that they create stay in its own queue, first in, first out;
/// dynamic   one queue for all workers, first in, first out;
/// stealing  created tasks go to the head of the worker's own queue, from where it takes its next task; a worker whose
/// queue is empty takes from the tail of another's, where the oldest and largest tasks are.
/// Every queue has a lock, held for a few instructions: contention is part of the comparison of the schemes.
class GrowingQueues {
  public:
    GrowingQueues(Schedule schedule, std::size_t workers);

    /// Adds a task with which an iteration begins; queues are assigned to polygons in turn. Must not be called while
    /// workers run.
    void deal(std::uint32_t polygon, PatchTask task);
    /// Adds the tasks that a worker's task has created, to be taken in this order.
    void push(std::size_t worker, std::span<const PatchTask> tasks);
    /// Takes the next task of a worker; empty if there is none at present.
    std::optional<PatchTask> next(std::size_t worker);
    /// Must be called after a task from next() has ended and the tasks that it created were pushed.
    void finish() { open_.fetch_sub(1, std::memory_order_acq_rel); }
    /// True if no task is left and none runs that could create others.
    bool are_done() const { return open_.load(std::memory_order_acquire) == 0; }
    std::size_t stolen() const { return stolen_.load(std::memory_order_relaxed); }

  private:
    struct alignas(64) Queue {
        std::mutex lock;
        std::deque<PatchTask> tasks;
        std::atomic<std::size_t> size{0};  ///< Number of tasks, read without the lock to skip empty queues.
    };
    enum class End { head, tail };
    std::optional<PatchTask> take(std::size_t queue, End end);

    Schedule schedule_;
    std::size_t count_;
    std::unique_ptr<Queue[]> queues_;
    alignas(64) std::atomic<std::size_t> open_{0};  ///< Number of tasks that wait or run.
    std::atomic<std::size_t> stolen_{0};
};

}  // namespace exitance

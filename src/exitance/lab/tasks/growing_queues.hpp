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

/// A patch whose list is to be processed, and the place of the task that made it in its worker's record.
struct PatchTask {
    std::uint32_t patch = 0;
    std::uint32_t maker = 0xffffffffu;  ///< A patch; none: the iteration begins with it.
};

/// Queues of tasks that make tasks. Source: the three schemes of [Vinod95].
///
/// static    a worker's tasks and what they make stay in its own queue, first in, first out;
/// dynamic   one queue for all, first in, first out;
/// stealing  what a task makes comes to the head of its worker's queue, from where the worker takes; who has none left
///           takes from the tail of another's, where the oldest and largest are.
/// A queue has a lock: that many workers want one is part of what the schemes differ in. Held for a few instructions.
class GrowingQueues {
  public:
    GrowingQueues(Schedule schedule, std::size_t workers);

    /// What an iteration begins with, dealt out by polygon like cards. Not while workers are about.
    void deal(std::uint32_t polygon, PatchTask task);
    /// What a worker's task has made, the first of them to be taken first.
    void push(std::size_t worker, std::span<const PatchTask> tasks);
    /// The next task of a worker; none at present.
    std::optional<PatchTask> next(std::size_t worker);
    /// A task that next() gave out has ended, and what it made is pushed.
    void finish() { open_.fetch_sub(1, std::memory_order_acq_rel); }
    /// Will no more tasks come?
    bool are_done() const { return open_.load(std::memory_order_acquire) == 0; }
    std::size_t stolen() const { return stolen_.load(std::memory_order_relaxed); }

  private:
    struct alignas(64) Queue {
        std::mutex lock;
        std::deque<PatchTask> tasks;
        std::atomic<std::size_t> size{0};  ///< Read without the lock, to pass by what is empty.
    };
    enum class End { head, tail };
    std::optional<PatchTask> take(std::size_t queue, End end);

    Schedule schedule_;
    std::size_t count_;
    std::unique_ptr<Queue[]> queues_;
    alignas(64) std::atomic<std::size_t> open_{0};  ///< Tasks that wait or run.
    std::atomic<std::size_t> stolen_{0};
};

}  // namespace exitance

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace exitance {

/// How the tasks of a parallel loop are assigned to workers: the three schemes studied for parallel radiosity, see
/// [Singh95].
enum class Schedule {
    fixed,     ///< "static": tasks are assigned once, and every worker runs only its own ones.
    dynamic,   ///< One queue shared by all workers.
    stealing,  ///< Tasks are assigned once; a worker without tasks takes some from the tail of other queues.
};

inline constexpr std::array<std::pair<Schedule, std::string_view>, 3> schedule_names{{
    {Schedule::fixed, "static"},
    {Schedule::dynamic, "dynamic"},
    {Schedule::stealing, "stealing"},
}};

/// The tasks of one loop, 0 to `tasks` - 1, in the order of a schedule. Every task is returned once, and the own tasks
/// of a worker in ascending order. Lock-free: a queue is two numbers in one atomic word.
class TaskQueues {
  public:
    static constexpr std::size_t none = ~std::size_t(0);

    /// homes the object, such as an input polygon, that each task belongs to. Objects are assigned to workers round
    /// robin, and tasks follow their object. Empty: the tasks themselves are assigned round robin.
    TaskQueues(Schedule schedule, std::size_t tasks, std::size_t workers, std::span<const std::uint32_t> homes = {});

    /// Returns the next task of a worker; `none` if there is none left for it.
    std::size_t next(std::size_t worker);

  private:
    /// Remaining places [head, tail) of a worker's queue; the head is in the upper 32 bits.
    struct alignas(64) Queue {
        std::atomic<std::uint64_t> range{0};
    };
    std::size_t take_head(std::size_t queue);
    std::size_t take_tail(std::size_t queue);
    std::size_t task(std::size_t queue, std::uint64_t place) const {
        return order_.empty() ? queue + place * queue_count_ : order_[place];
    }

    Schedule schedule_;
    std::size_t queue_count_;
    std::vector<std::uint32_t> order_;  ///< Tasks sorted by worker; empty: place k of worker w is task w + k workers.
    std::unique_ptr<Queue[]> queues_;
};

}  // namespace exitance

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

/// How the tasks of a parallel loop come to workers: the three schemes of the studies of parallel radiosity, see
/// [Singh95].
enum class Schedule {
    fixed,     ///< "static": dealt out once; everybody keeps to his own.
    dynamic,   ///< One queue, which all workers share.
    stealing,  ///< Dealt out once; who has none left takes them from the tail of others' queues.
};

inline constexpr std::array<std::pair<Schedule, std::string_view>, 3> schedule_names{{
    {Schedule::fixed, "static"},
    {Schedule::dynamic, "dynamic"},
    {Schedule::stealing, "stealing"},
}};

/// The tasks of one loop, 0 to `tasks` - 1, as a schedule hands them out. Each is handed out once, to whoever asks; a
/// worker's own come in rising order. Without locks: a queue is two numbers in one atomic word.
class TaskQueues {
  public:
    static constexpr std::size_t none = ~std::size_t(0);

    /// `homes`: the thing, such as an input polygon, that each task belongs to; things are dealt out like cards, and
    /// tasks follow theirs. Empty: tasks themselves are dealt out like cards.
    TaskQueues(Schedule schedule, std::size_t tasks, std::size_t workers, std::span<const std::uint32_t> homes = {});

    /// The next task of a worker; `none` when there is none left for it.
    std::size_t next(std::size_t worker);

  private:
    /// What is left of a worker's own places: [head, tail), the head in the upper half.
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
    std::vector<std::uint32_t> order_;  ///< Tasks by worker; empty: place k of worker w is task w + k workers.
    std::unique_ptr<Queue[]> queues_;
};

}  // namespace exitance

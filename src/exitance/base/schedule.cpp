#include "exitance/base/schedule.hpp"

#include "exitance/base/check.hpp"

namespace exitance {
namespace {

constexpr std::uint64_t range_of(std::uint64_t head, std::uint64_t tail) {
    return head << 32 | tail;
}
constexpr std::uint64_t head_of(std::uint64_t range) {
    return range >> 32;
}
constexpr std::uint64_t tail_of(std::uint64_t range) {
    return range & 0xffffffffu;
}

}  // namespace

TaskQueues::TaskQueues(Schedule schedule, std::size_t tasks, std::size_t workers, std::span<const std::uint32_t> homes)
    : schedule_(schedule),
      queue_count_(schedule == Schedule::dynamic ? 1 : workers),
      queues_(std::make_unique<Queue[]>(queue_count_)) {
    EXI_CHECK(tasks <= 0xffffffffu);
    if (homes.empty() || schedule == Schedule::dynamic) {
        for (std::size_t w = 0; w < queue_count_; ++w)
            queues_[w].range = range_of(0, (tasks + queue_count_ - 1 - w) / queue_count_);
        return;
    }
    std::vector<std::size_t> place(workers + 1, 0);
    for (std::uint32_t home : homes) ++place[home % workers + 1];
    for (std::size_t w = 0; w < workers; ++w) {
        place[w + 1] += place[w];
        queues_[w].range = range_of(place[w], place[w + 1]);
    }
    order_.resize(tasks);
    for (std::size_t t = 0; t < tasks; ++t) order_[place[homes[t] % workers]++] = static_cast<std::uint32_t>(t);
}

std::size_t TaskQueues::take_head(std::size_t queue) {
    std::atomic<std::uint64_t>& left = queues_[queue].range;
    std::uint64_t range = left.load(std::memory_order_relaxed);
    while (head_of(range) < tail_of(range))
        if (left.compare_exchange_weak(range, range_of(head_of(range) + 1, tail_of(range)), std::memory_order_relaxed))
            return task(queue, head_of(range));
    return none;
}

std::size_t TaskQueues::take_tail(std::size_t queue) {
    std::atomic<std::uint64_t>& left = queues_[queue].range;
    std::uint64_t range = left.load(std::memory_order_relaxed);
    while (head_of(range) < tail_of(range))
        if (left.compare_exchange_weak(range, range - 1, std::memory_order_relaxed))
            return task(queue, tail_of(range) - 1);
    return none;
}

std::size_t TaskQueues::next(std::size_t worker) {
    if (schedule_ == Schedule::dynamic) return take_head(0);
    const std::size_t own = take_head(worker);
    if (own != none || schedule_ == Schedule::fixed) return own;
    for (std::size_t i = 1; i < queue_count_; ++i) {
        const std::size_t stolen = take_tail((worker + i) % queue_count_);
        if (stolen != none) return stolen;
    }
    return none;
}

}  // namespace exitance

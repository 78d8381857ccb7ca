#include "exitance/lab/tasks/growing_queues.hpp"

namespace exitance {

GrowingQueues::GrowingQueues(Schedule schedule, std::size_t workers)
    : schedule_(schedule),
      count_(schedule == Schedule::dynamic ? 1 : workers),
      queues_(std::make_unique<Queue[]>(count_)) {}

void GrowingQueues::deal(std::uint32_t polygon, PatchTask task) {
    Queue& queue = queues_[polygon % count_];
    queue.tasks.push_back(task);
    queue.size.fetch_add(1, std::memory_order_relaxed);
    open_.fetch_add(1, std::memory_order_relaxed);
}

void GrowingQueues::push(std::size_t worker, std::span<const PatchTask> tasks) {
    if (tasks.empty()) return;
    open_.fetch_add(tasks.size(), std::memory_order_acq_rel);
    Queue& queue = queues_[worker % count_];
    const std::lock_guard guard(queue.lock);
    if (schedule_ == Schedule::stealing)
        queue.tasks.insert(queue.tasks.begin(), tasks.begin(), tasks.end());
    else
        queue.tasks.insert(queue.tasks.end(), tasks.begin(), tasks.end());
    queue.size.store(queue.tasks.size(), std::memory_order_relaxed);
}

std::optional<PatchTask> GrowingQueues::take(std::size_t at, End end) {
    Queue& queue = queues_[at];
    if (queue.size.load(std::memory_order_relaxed) == 0) return {};
    const std::lock_guard guard(queue.lock);
    if (queue.tasks.empty()) return {};
    const PatchTask task = end == End::head ? queue.tasks.front() : queue.tasks.back();
    if (end == End::head)
        queue.tasks.pop_front();
    else
        queue.tasks.pop_back();
    queue.size.store(queue.tasks.size(), std::memory_order_relaxed);
    return task;
}

std::optional<PatchTask> GrowingQueues::next(std::size_t worker) {
    if (std::optional<PatchTask> own = take(worker % count_, End::head)) return own;
    if (schedule_ != Schedule::stealing) return {};
    for (std::size_t i = 1; i < count_; ++i)
        if (std::optional<PatchTask> other = take((worker + i) % count_, End::tail)) {
            stolen_.fetch_add(1, std::memory_order_relaxed);
            return other;
        }
    return {};
}

}  // namespace exitance

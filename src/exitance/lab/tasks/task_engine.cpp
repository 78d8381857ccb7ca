#include "exitance/lab/tasks/task_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <tuple>
#include <unordered_map>

namespace exitance {
namespace {

/// Runs one worker's part of an iteration, until no task is left that could create others.
void work(GrowingQueues& queues, TaskWorker& worker, std::size_t number, const IterationState& iteration) {
    while (!queues.are_done()) {
        const std::optional<PatchTask> task = queues.next(number);
        if (!task) {
            std::this_thread::yield();
            continue;
        }
        worker.process(*task, iteration);
        queues.push(number, worker.made());
        queues.finish();
    }
}

}  // namespace

TaskEngine::TaskEngine(const Stage& stage, const TaskOptions& options)
    : stage_(stage), options_(options), patches_(stage, options.seed) {
    options_.threads = std::max<std::size_t>(1, options.threads);
    for (std::size_t w = 0; w < options_.threads; ++w)
        workers_.emplace_back(stage_, options_, patches_, static_cast<std::uint32_t>(w));
    graph_.workers = options_.threads;
}

TaskReport TaskEngine::run(Progress& progress, const StopRequest& stop, double origin,
                           const std::function<void(const TaskReport&)>& end_iteration) {
    const Stopwatch clock;
    double total = total_radiosity();
    while (report_.iterations < options_.max_iterations && !report_.converged && !stop.requested()) {
        ++iteration_;
        TaskGraph::Iteration iteration{.begin = origin + clock.seconds()};
        const IterationState state{iteration_, patches_.size(), stop, clock, origin};
        GrowingQueues queues(options_.schedule, options_.threads);
        for (std::uint32_t root = 0; root < patches_.root_count(); ++root) queues.deal(root, {root, TaskPatch::none});
        {
            std::vector<std::jthread> threads;
            for (std::size_t w = 1; w < options_.threads; ++w)
                threads.emplace_back([&, w] { work(queues, workers_[w], w, state); });
            work(queues, workers_[0], 0, state);
        }
        const double barrier = clock.seconds();
        settle_new_patches(state.old_size);
        if (iteration_ == 1) collect_pairs();
        ++report_.iterations;
        report_.stolen += queues.stolen();
        const double before = std::exchange(total, total_radiosity());
        report_.change = total > 0 ? std::abs(total - before) / total : 0;
        report_.converged = report_.change <= options_.change;
        iteration.total_radiosity = total;
        iteration.end = origin + clock.seconds();
        iteration.serial = clock.seconds() - barrier;
        report_.serial += iteration.serial;
        if (options_.record) record(iteration);
        progress.advance(report_.converged ? 1 : std::min(0.9, options_.change / report_.change),
                         fmt::format("iteration {}, total radiosity {:.6g}", report_.iterations, total));
        if (end_iteration) end_iteration(counted());
    }
    report_.wall = clock.seconds();
    return counted();
}

/// The report with the counts of patches and workers.
TaskReport TaskEngine::counted() const {
    TaskReport out = report_;
    out.initial_interactions = visible_pairs_.size(), out.interactions = 0;
    for (std::uint32_t id = 0; id < patches_.size(); ++id) out.interactions += patches_[id].list.size();
    for (const TaskWorker& worker : workers_) {
        out.rays += worker.rays;
        out.form_factors += worker.form_factors;
        out.tasks += worker.tasks;
        for (std::size_t k = 0; k < worker.seconds.size(); ++k) out.seconds[k] += worker.seconds[k];
    }
    return out;
}

/// Copies the parent's light to patches that were split off for another patch's list in this iteration; tasks processed
/// all older ones. Parents come first, as their ids are smaller.
void TaskEngine::settle_new_patches(std::uint32_t old_size) {
    for (std::uint32_t id = old_size; id < patches_.size(); ++id) {
        TaskPatch& patch = patches_[id];
        if (patch.reached == iteration_) continue;
        const TaskPatch& parent = patches_[patch.parent];
        patch.irradiance = parent.irradiance;
        patch.radiosity[iteration_ % 2] = parent.radiosity[iteration_ % 2];
    }
}

void TaskEngine::save(ArchiveWriter& a) {
    TaskReport report = counted();
    std::uint32_t size = patches_.size();
    a(iteration_, report, visible_pairs_, size);
    for (std::uint32_t id = 0; id < size; ++id) {
        TaskPatch& patch = patches_[id];
        std::uint32_t first_child = patch.first_child.load();
        a(first_child, patch.list, patch.irradiance, patch.radiosity, patch.reached);
    }
}

void TaskEngine::restore(ArchiveReader& a) {
    std::uint32_t size = 0;
    a(iteration_, report_, visible_pairs_, size);
    // Parents come before their children, so that patches are made in the order of their ids, which are new ones.
    std::vector<std::uint32_t> now(size);
    for (std::uint32_t root = 0; root < patches_.root_count(); ++root) now[root] = root;
    for (std::uint32_t id = 0; id < size; ++id) {
        std::uint32_t first_child = TaskPatch::none;
        TaskPatch& patch = patches_[now[id]];
        a(first_child, patch.list, patch.irradiance, patch.radiosity, patch.reached);
        if (first_child == TaskPatch::none) continue;
        const std::uint32_t first = patches_.children(now[id], 0);
        for (std::uint32_t c = 0; c < 4; ++c) now[first_child + c] = first + c;
    }
    for (std::uint32_t id = 0; id < patches_.size(); ++id)
        for (Interaction& i : patches_[id].list) i.source = now[i.source];
}

double TaskEngine::total_radiosity() const {
    double sum = 0;
    for (std::uint32_t root = 0; root < patches_.root_count(); ++root)
        sum += patches_[root].area * mean(radiosity(root));
    return sum;
}

void TaskEngine::collect_pairs() {
    for (TaskWorker& worker : workers_)
        visible_pairs_.insert(visible_pairs_.end(), worker.visible_pairs.begin(), worker.visible_pairs.end());
    std::sort(visible_pairs_.begin(), visible_pairs_.end(), [](const PiecePair& a, const PiecePair& b) {
        return std::pair(a.receiver, a.source) < std::pair(b.receiver, b.source);
    });
}

/// Appends the workers' records to the graph in an order that does not depend on the workers: by piece, parents before
/// children.
void TaskEngine::record(TaskGraph::Iteration iteration) {
    std::vector<TaskWorker::Record> all;
    for (TaskWorker& worker : workers_) {
        all.insert(all.end(), worker.records.begin(), worker.records.end());
        worker.records.clear();
    }
    const auto name = [&](const TaskWorker::Record& r) {
        const TaskPatch& patch = patches_[r.patch];
        return std::tuple(patch.polygon, patch.path, patch.level);
    };
    std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return name(a) < name(b); });
    iteration.first_task = graph_.tasks.size();
    iteration.task_count = all.size();
    std::unordered_map<std::uint32_t, std::uint32_t> index;
    for (TaskWorker::Record& r : all) {
        index[r.patch] = static_cast<std::uint32_t>(graph_.tasks.size());
        r.task.maker = r.maker == TaskPatch::none ? TaskGraph::none : index.at(r.maker);
        graph_.tasks.push_back(r.task);
    }
    graph_.iterations.push_back(iteration);
}

std::size_t TaskEngine::memory_bytes() const {
    std::size_t bytes = patches_.memory_bytes();
    for (std::uint32_t id = 0; id < patches_.size(); ++id) bytes += patches_[id].list.capacity() * sizeof(Interaction);
    return bytes;
}

}  // namespace exitance

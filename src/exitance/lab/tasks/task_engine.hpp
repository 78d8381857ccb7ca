#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/task_graph.hpp"
#include "exitance/lab/tasks/task_worker.hpp"

namespace exitance {

struct TaskReport {
    std::size_t iterations = 0, interactions = 0, initial_interactions = 0;
    std::size_t rays = 0, form_factors = 0, tasks = 0, stolen = 0;
    std::array<double, 5> seconds{};  ///< Processor time of all tasks, by TaskGraph::Cost.
    double wall = 0, serial = 0;      ///< Of all iterations, and of that behind barriers.
    double change = 0;                ///< Of the total radiosity in the last iteration, relative.
    bool converged = false;           ///< That is below what was asked for.
};

/// Classical hierarchical radiosity, gathered by tasks that make tasks. Source: [Hanrahan91], [Vinod95].
///
/// A task is a patch with its list of interactions. It finds the form factor and visibility of those that are new,
/// refines those that are too strong (the larger of the two patches is cut: the receiver's parts inherit the
/// interaction, a source's parts take its place on the list), gathers radiosity over the rest, and makes tasks of its
/// children. The last of four siblings to end pulls their radiosity up. Behind one barrier an iteration ends; the next
/// begins at the pieces, with all lists as they were left.
///
/// Same bits under every schedule and number of threads, since a task's result is a function of its own list and of
/// what the last iteration has left: it reads others' radiosity of the last iteration alone (two slots take turns);
/// what a patch is follows from its name, whoever cut it first; a patch cut for others' sake in this iteration has its
/// parent's radiosity of the last one, and is gathered to from the next one on; only its parent's task, which has
/// ended then, and its own write to a list, in an order of their own; sums run in the list's order, and those over four
/// children in theirs. Clocks, workers and ids differ; none of these is read by the arithmetic.
class TaskEngine {
  public:
    TaskEngine(const Stage& stage, const TaskOptions& options);

    /// Iterates until the total radiosity stands still. `origin` seconds are added to the graph's times. A stop ends
    /// refinement at once, and iterations behind the next barrier.
    TaskReport run(Progress& progress, const StopRequest& stop, double origin = 0);

    const PatchPool& patches() const { return patches_; }
    /// Where it was to be recorded.
    const TaskGraph& graph() const { return graph_; }
    TaskGraph take_graph() { return std::move(graph_); }
    /// By receiver, then by source.
    const std::vector<PiecePair>& visible_pairs() const { return visible_pairs_; }
    /// Radiosity of a patch after the last iteration, W/m^2.
    const Spectrum& radiosity(std::uint32_t id) const { return patches_[id].radiosity[iteration_ % 2]; }
    std::size_t memory_bytes() const;

  private:
    void settle_new_patches(std::uint32_t old_size);
    void collect_pairs();
    void count();
    void record(TaskGraph::Iteration iteration);
    double total_radiosity() const;

    const Stage& stage_;
    TaskOptions options_;
    PatchPool patches_;
    TaskGraph graph_;
    TaskReport report_;
    std::vector<PiecePair> visible_pairs_;
    std::vector<TaskWorker> workers_;
    std::uint32_t iteration_ = 0;  ///< From 1 on.
};

}  // namespace exitance

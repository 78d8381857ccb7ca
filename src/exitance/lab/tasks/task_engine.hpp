#pragma once

#include <functional>
#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/base/task_graph.hpp"
#include "exitance/lab/tasks/task_worker.hpp"

namespace exitance {

struct TaskReport {
    std::size_t iterations = 0, interactions = 0, initial_interactions = 0;
    std::size_t rays = 0, form_factors = 0, tasks = 0, stolen = 0;
    std::array<double, 5> seconds{};  ///< Processor time of all tasks, by TaskGraph::Cost.
    double wall = 0, serial = 0;      ///< Wall time of all iterations, and of their parts behind barriers, seconds.
    double change = 0;                ///< Relative change of the total radiosity in the last iteration.
    bool converged = false;           ///< True if `change` is at most the requested one.
};

/// Classical hierarchical radiosity, gathered by tasks that create tasks. Source: [Hanrahan91], [Vinod95].
///
/// A task processes a patch and its list of interactions. It computes form factor and visibility of new interactions.
/// It refines those that are too strong by splitting the larger of the two patches: parts of the receiver inherit the
/// interaction, parts of a source replace it in the list. It gathers radiosity through the others and creates tasks for
/// the patch's children. The last of four siblings to finish computes the radiosity of the parent. An iteration ends
/// with one barrier; the next starts at the pieces and continues with the present lists.
///
/// Results have the same bits for every schedule and number of threads, since a task's result depends only on its own
/// list and on the results of the last iteration. Radiosities are double-buffered, and a task reads only those of the
/// last iteration. A patch's contents depend on its path, not on the thread that creates it. A patch that another
/// patch's task splits off in this iteration has its parent's radiosity of the last one and gathers from the next one
/// on. A list is written only by its parent's task, which has ended by then, and by its own task, each in a fixed
/// order. Sums over a list and over four children have a fixed order. Times, workers and ids differ, but arithmetic
/// does not use them.
class TaskEngine {
  public:
    TaskEngine(const Stage& stage, const TaskOptions& options);

    /// Iterates until the total radiosity has converged. `origin`: offset added to the times of the graph, seconds. A
    /// stop request ends refinement at once, and the iteration at the next barrier. `end_iteration` is called after
    /// each iteration with the counts so far.
    TaskReport run(Progress& progress, const StopRequest& stop, double origin = 0,
                   const std::function<void(const TaskReport&)>& end_iteration = {});

    const PatchPool& patches() const { return patches_; }
    /// The recorded graph of tasks; empty unless options.record is set.
    const TaskGraph& graph() const { return graph_; }
    TaskGraph take_graph() { return std::move(graph_); }
    /// Saves or restores the patches with their interactions and light, and the counts so far, between iterations. To
    /// be restored into an engine that has not run.
    void save(ArchiveWriter& a);
    void restore(ArchiveReader& a);
    /// Pairs of visible pieces, sorted by receiver, then by source.
    const std::vector<PiecePair>& visible_pairs() const { return visible_pairs_; }
    /// Radiosity of a patch after the last iteration, W/m^2.
    const Spectrum& radiosity(std::uint32_t id) const { return patches_[id].radiosity[iteration_ % 2]; }
    std::size_t memory_bytes() const;

  private:
    void settle_new_patches(std::uint32_t old_size);
    void collect_pairs();
    TaskReport counted() const;
    void record(TaskGraph::Iteration iteration);
    double total_radiosity() const;

    const Stage& stage_;
    TaskOptions options_;
    PatchPool patches_;
    TaskGraph graph_;
    TaskReport report_;
    std::vector<PiecePair> visible_pairs_;
    std::vector<TaskWorker> workers_;
    std::uint32_t iteration_ = 0;  ///< Counted from 1.
};

}  // namespace exitance

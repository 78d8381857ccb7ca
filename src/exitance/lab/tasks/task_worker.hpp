#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/task_graph.hpp"
#include "exitance/lab/tasks/growing_queues.hpp"
#include "exitance/lab/tasks/patch_pool.hpp"
#include "exitance/lab/tasks/task_options.hpp"

namespace exitance {

/// Two pieces that are visible to each other, found in the first iteration.
struct PiecePair {
    std::uint32_t receiver = 0, source = 0;
    float form_factor = 0;  ///< F of the receiver without occlusion.
};

/// Data shared by all tasks of an iteration.
struct IterationState {
    std::uint32_t number = 1;
    std::uint32_t old_size = 0;  ///< Patches from here on were made in this iteration.
    const StopRequest& stop;
    const Stopwatch& clock;
    double origin = 0;  ///< Offset of recorded times, seconds.

    std::size_t last() const { return (number + 1) % 2; }  ///< Slot of the radiosities that are read.
    std::size_t present() const { return number % 2; }     ///< Slot of the radiosities that are written.
};

/// Processes tasks one at a time; one object per thread. The results do not depend on which worker runs a task.
class alignas(64) TaskWorker {
  public:
    TaskWorker(const Stage& stage, const TaskOptions& options, PatchPool& patches, std::uint32_t number)
        : stage_(&stage), options_(&options), patches_(&patches), number_(number) {}

    /// Processes a task. The tasks that it creates are in made() until the next call.
    void process(const PatchTask& task, const IterationState& iteration);
    std::span<const PatchTask> made() const { return made_; }

    /// A recorded task, with patches instead of indices into the graph.
    struct Record {
        std::uint32_t patch = 0, maker = 0;
        TaskGraph::Task task;
    };
    std::vector<Record> records;           ///< Filled if options.record is set.
    std::vector<PiecePair> visible_pairs;  ///< Found in the first iteration.
    std::size_t rays = 0, form_factors = 0, tasks = 0;
    std::array<double, 5> seconds{};  ///< Processor time of all tasks, by TaskGraph::Cost.

  private:
    void link_pieces(std::uint32_t p);
    void find_form_factors(const TaskPatch& patch);
    void find_visibility(const TaskPatch& patch);
    void refine(std::uint32_t p);
    void cut_interaction(std::uint32_t p, const Interaction& interaction);
    bool is_too_strong(const TaskPatch& patch, const Interaction& interaction) const;
    float form_factor(const TaskPatch& p, const TaskPatch& q);
    float visible_share(const TaskPatch& p, const TaskPatch& q);
    void gather(TaskPatch& patch);
    void hand_down(std::uint32_t p);
    void finish_leaf(TaskPatch& patch);
    void pull_up(const TaskPatch& patch);
    void spend(TaskGraph::Cost kind);
    void record(const PatchTask& task, double begin);

    const Stage* stage_;
    const TaskOptions* options_;
    PatchPool* patches_;
    std::uint32_t number_;
    const IterationState* iteration_ = nullptr;
    std::vector<PatchTask> made_;
    /// Interactions to be examined; parts of split ones; accepted ones.
    std::vector<Interaction> fresh_, next_, kept_;
    std::array<double, 5> before_{};  ///< `seconds` when the current task began.
    double mark_ = 0;                 ///< Processor time at the last call of spend().
};

}  // namespace exitance

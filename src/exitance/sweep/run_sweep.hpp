#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/sweep/resolved_step.hpp"
#include "exitance/sweep/step_store.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// State of a variant, and its steps.
struct VariantState {
    enum class Kind { done, running, failed, to_do };

    Kind kind = Kind::to_do;
    ResolvedVariant variant;
    std::size_t finished_steps = 0;
    std::string failure;  ///< Step, reason and folder, if a step failed or its result is damaged.
};

/// Name of a state: "done", "running", "failed" or "to do".
std::string name_of(VariantState::Kind kind);

/// States of all variants.
Result<std::vector<VariantState>> sweep_states(const SweepPlan& plan);

/// Result of a run of variants.
struct SweepReport {
    std::size_t variants = 0, done = 0;
    std::size_t steps_run = 0, steps_reused = 0;
    std::vector<std::string> failures;  ///< One text per failed variant, with its number, step, reason and folder.
    std::vector<std::string> warnings;  ///< Damaged results that were replaced.
};

/// Runs variants (numbers from 0), `jobs` at a time. A step that another variant or another process runs is waited for;
/// a failed step fails the variants that need it, and the others are run. After a stop is requested, running steps end
/// without a result. Folders of variants that the plan no longer has are removed if all variants are run. Error:
/// cannot_write, or an error of the plan.
Result<SweepReport> run_sweep(const SweepPlan& plan, const std::vector<std::size_t>& variants, int jobs,
                              const StepRunner& runner, Progress& progress, const StopRequest& stop);

/// Makes the folders of all variants agree with their states: links the files of finished variants, and removes folders
/// of other parameters or inputs and of variants that the plan no longer has. Files of the user stay. Error:
/// cannot_write.
Result<void> update_variant_folders(const SweepPlan& plan, const std::vector<VariantState>& states);

/// Folder of a variant's results: links to the files of its steps.
std::string variant_folder(const SweepPlan& plan, std::size_t index);

}  // namespace exitance

#pragma once

#include <optional>
#include <set>
#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/sweep/resolved_step.hpp"
#include "exitance/sweep/step_lock.hpp"

namespace exitance {

/// Why a step failed, kept until it is run again.
struct StepFailure {
    int status = 0;  ///< Exit status of the command; 1000 + the signal number if a signal ended it.
    std::string message;
    std::string command;  ///< Command line for a shell in the folder of the plan.
};

/// How the commands of steps are run.
struct StepRunner {
    std::string program;             ///< Path of exitance.
    std::string base;                ///< Working folder.
    std::set<std::string> threaded;  ///< Verbs with the option --threads.
    int threads = 0;                 ///< Threads of every command that does not choose them itself; 0: all cores.
};

/// Finished steps, one folder per key: FOLDER/steps/KEY with the files of the step, and its output in `stdout.txt` and
/// `stderr.txt`. A folder appears whole or not at all, and is compared with its record before it is used. Steps of
/// several variants, plans and processes share it.
class StepStore {
  public:
    explicit StepStore(std::string folder) : folder_(std::move(folder)) {}

    /// Folder of a step's files once it is finished.
    std::string path(const ResolvedStep& step) const;
    bool is_finished(const ResolvedStep& step) const;
    /// Damage of the files of a step that was finished, such as "room.h5 is missing"; empty if there is none. A damaged
    /// step is not finished.
    std::string damage(const ResolvedStep& step) const;
    /// True if a running process works on the step.
    bool is_running(const ResolvedStep& step) const;
    std::optional<StepFailure> failure(const ResolvedStep& step) const;
    /// Folder of a failed step: its output, its files, and `failure.json`.
    std::string failure_path(const ResolvedStep& step) const { return path(step) + ".failed"; }

    enum class Outcome { finished, was_finished, busy, failed, stopped };
    /// Runs a step unless it is finished or another process runs it. On failure, the reason is in failure(). Error:
    /// cannot_write.
    Result<Outcome> run(const ResolvedStep& step, const StepRunner& runner, const StopRequest& stop);

  private:
    std::string lock_path(const ResolvedStep& step) const { return path(step) + ".lock"; }
    std::string unfinished_path(const ResolvedStep& step) const;
    Result<void> keep(const ResolvedStep& step, const std::string& work) const;
    Result<Outcome> fail(const ResolvedStep& step, const std::string& work, const StepFailure& failure) const;
    Result<void> prepare(const ResolvedStep& step, const std::string& work) const;
    Result<Outcome> run_command(const ResolvedStep& step, const std::string& work, const StepRunner& runner,
                                const StopRequest& stop) const;

    std::string folder_;
    LockRenewal renewal_;
};

}  // namespace exitance

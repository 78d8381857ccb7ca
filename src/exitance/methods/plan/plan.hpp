#pragma once

#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// All decisions about a solve, made once. Read by the solve, by the forecast of `--dry-run` and by the memory limit.
struct Plan {
    SolveOptions options;                   ///< Requested options, with the chosen method, basis and clusters.
    std::string why = {};                   ///< Reason for the choice of the method; empty if the user chose.
    std::vector<std::string> notices = {};  ///< Notices about the choices, for the user.
    Knobs knobs = {};                       ///< Settings of the first attempt.
    bool has_links = false;                 ///< True if the method uses links.
    bool sums = false;                      ///< True if light is summed over elements instead of sampled by rays.
    /// True if another attempt may refine the delivered light (`next_light`) if the method's part of the error is too
    /// large.
    bool may_step_on_delivered = false;
};

/// Finds the unlit sides and the rooms of the stage, on which a plan depends.
void survey(Stage& stage, const SolveOptions& options, const StopRequest& stop);

/// Makes the plan for a stage after `survey`. The first attempt aims at `first_error` if that is larger than the
/// requested error, so that a coarse solution comes first.
Plan make_plan(const Stage& stage, const SolveOptions& asked, double first_error = 0);

/// Returns the plan's settings for an attempt that aims at another error.
Knobs first_knobs(const Plan& plan, const Stage& stage, double error);

}  // namespace exitance

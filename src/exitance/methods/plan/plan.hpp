#pragma once

#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// What a solve is going to do, made once: the solve, the forecast of `--dry-run` and the memory limit read it.
struct Plan {
    SolveOptions options;                   ///< As asked for, with the method, its basis and its clusters as chosen.
    std::string why = {};                   ///< Why this method; empty where the user chose.
    std::vector<std::string> notices = {};  ///< What the user should be told of the choices.
    Knobs knobs = {};                       ///< Of the first attempt.
    bool has_links = false;                 ///< Is the method one over links?
    bool sums = false;                      ///< Is light summed over elements rather than found by rays?
    /// May another attempt refine what is delivered (`next_light`), where the method is to blame?
    bool may_refine_delivered = false;
};

/// Looks for the sides of the stage that get no light and for its rooms; what a plan rests on.
void survey(Stage& stage, const SolveOptions& options, const StopRequest& stop);

/// The plan for a stage that is surveyed. The first attempt aims at `first_error` where that is above the error
/// requested: a coarse answer comes first.
Plan make_plan(const Stage& stage, const SolveOptions& asked, double first_error = 0);

/// The knobs that the plan would have for an attempt that aims at another error.
Knobs first_knobs(const Plan& plan, const Stage& stage, double error);

}  // namespace exitance

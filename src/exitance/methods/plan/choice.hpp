#pragma once

#include <string>

#include "exitance/methods/plan/way_forecast.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// The options with the method that solves in place of `auto`, its basis, and why that.
struct MethodChoice {
    SolveOptions options;
    std::string why = {};       ///< Empty where the user chose.
    WayForecast forecast = {};  ///< Where there is a choice of transport, whoever chose the method.
    bool is_second = false;     ///< What would have been chosen does not run over the processes that there are.
};

/// Are its steps those of all unknowns at once, so that several processes can share them?
bool runs_over_processes(Relaxation relaxation);
/// Can several processes share the method's work? That of `matrix` on rows of rays, and of `hierarchical` where rays
/// find the links, too: not where something asked for has them judged one by one.
bool runs_over_processes(Method method, const SolveOptions& options);

/// By what is asked for and what stands in the scene; where nothing stands between any two places, by a forecast of the
/// work that each way takes to the error. Where several processes work together and the choice
/// does not run over them, the next that does, which is `matrix` on rows of rays.
MethodChoice choose_method(const Stage& stage, const SolveOptions& options);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/methods/plan/delivery_forecast.hpp"
#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Options with the chosen method and basis in place of `auto`, and the reason for the choice.
struct MethodChoice {
    SolveOptions options;
    std::string why = {};            ///< Reason; empty if the user chose.
    DeliveryForecast forecast = {};  ///< Forecast of the work; infinite values if there is no choice.
    bool is_second = false;          ///< True if the preferred method does not run on several processes.
};

/// True if the relaxation updates all unknowns at once, so that several processes can share its steps.
bool runs_over_processes(Relaxation relaxation);
/// True if several processes can share the work of the method. This holds for `matrix` with rows sampled by rays, and
/// for `hierarchical` if rays find the links and no option requires links to be evaluated one by one.
bool runs_over_processes(Method method, const SolveOptions& options);

/// Chooses a method by the requested options and the scene. Without occlusion in the scene, it compares forecasts of
/// the work that each method needs to reach the requested error. If several processes solve together and the preferred
/// method does not support that, it chooses `matrix` with rows sampled by rays.
MethodChoice choose_method(const Stage& stage, const SolveOptions& options);

}  // namespace exitance

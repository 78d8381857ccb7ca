#pragma once

#include <cmath>
#include <string>

#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Predicted work of the ways to reach the requested error in a scene, in rays: numbers of elements, places and pairs
/// times the cost of one. Infinite if a way is not applicable to the scene or was not evaluated.
struct DeliveryForecast {
    double rays = HUGE_VAL;   ///< `matrix`, with light gathered by rays.
    double sums = HUGE_VAL;   ///< `matrix`, with light summed over elements (`ElementGather`).
    double links = HUGE_VAL;  ///< `wavelet` of order 3, with light delivered by the links.
    bool takes_sums() const { return sums < rays; }
    bool takes_links() const { return links < rays && links < sums; }
};

/// Forecasts the work in scenes without occlusion. Elsewhere, all results are infinite: links do not deliver light
/// there, and sums would ignore occluders. Elements are counted by creating the initial meshes, rays by the matrix
/// rows. Links are evaluated only if they `may_deliver` and the solve is long enough for a pilot to take at most three
/// percent of it. The pilot gathers direct light on a coarse mesh at 256 points with 64 rays each. Its spread predicts
/// the error of constant elements, and thus whether one attempt will suffice. O(elements).
DeliveryForecast forecast_delivery(const Stage& stage, const SolveOptions& options, bool may_deliver);

/// Returns a message for the user.
std::string describe(const DeliveryForecast& forecast);

}  // namespace exitance

#pragma once

#include <cmath>
#include <string>

#include "exitance/solve/solve_options.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Work of the ways to the error asked for in this scene, before anything is solved, in rays: counts of elements,
/// places and pairs times what one of them takes. Infinite where a way does not suit the scene or was not counted.
struct WayForecast {
    double rays = HUGE_VAL;   ///< `matrix`, whose light is gathered by rays,
    double sums = HUGE_VAL;   ///< or summed over elements (`ElementGather`);
    double links = HUGE_VAL;  ///< `wavelet` of order 3, whose links deliver the light.
    bool takes_sums() const { return sums < rays; }
    bool takes_links() const { return links < rays && links < sums; }
};

/// Where nothing stands between any two places, there is a choice: elements of the first meshes, which are made for
/// that, and rays of their rows are counted. Links are counted, if they `may_deliver`, where so much is to be done that
/// a look at the light takes at most three percent of it. That is direct light on a coarse mesh, gathered at 256 points
/// by 64 rays: the spread of these tells how far constant elements will err, and so whether one attempt will do.
/// Elsewhere nothing is counted, for links do not deliver there, and sums would miss what hides. O(elements).
WayForecast forecast_ways(const Stage& stage, const SolveOptions& options, bool may_deliver);

/// For people.
std::string describe(const WayForecast& forecast);

}  // namespace exitance

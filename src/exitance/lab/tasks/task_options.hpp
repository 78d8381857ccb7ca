#pragma once

#include <cstddef>
#include <cstdint>

#include "exitance/base/schedule.hpp"

namespace exitance {

/// Options of a TaskEngine.
struct TaskOptions {
    /// Refinement criterion: true: the power F_pq A_p B_q (bf); false: the larger of the two form factors (ff).
    bool by_power = true;
    /// W in the brightest band with by_power, else without unit; halved for partly visible pairs.
    double threshold = 0;
    double min_area = 0;  ///< Smallest area of the parts of a split patch, m^2.
    /// Iterations end when the total radiosity changes by less than this share, or after `max_iterations`.
    double change = 0;
    std::size_t max_iterations = 0;
    std::size_t rays = 16;  ///< Rays per interaction; a multiple of 16.
    bool triage = true;     ///< If all rays of a pair are unoccluded, assume that its parts are visible.
    Schedule schedule = Schedule::stealing;
    std::size_t threads = 1;
    std::uint64_t seed = 1;
    bool record = false;  ///< Record the graph of tasks.
};

}  // namespace exitance

#pragma once

#include <cstddef>
#include <cstdint>

#include "exitance/base/schedule.hpp"

namespace exitance {

/// What a TaskEngine is asked for.
struct TaskOptions {
    /// Is an interaction judged by its power F_pq A_p B_q (bf), or by the larger of its two form factors (ff)?
    bool by_power = true;
    double threshold = 0;  ///< W in the brightest band, or without a unit; halved where a pair is partly visible.
    double min_area = 0;   ///< No patch is cut whose parts would be smaller, m^2.
    /// Iterations end when the total radiosity changes by less than this share of itself, or after so many.
    double change = 0;
    std::size_t max_iterations = 0;
    std::size_t rays = 16;  ///< An interaction; a multiple of 16.
    bool triage = true;     ///< Parts of a pair whose rays all passed are held to be visible.
    Schedule schedule = Schedule::stealing;
    std::size_t threads = 1;
    std::uint64_t seed = 1;
    bool record = false;  ///< Keep the graph of tasks.
};

}  // namespace exitance

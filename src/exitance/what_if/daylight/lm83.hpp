#pragma once

#include "exitance/what_if/daylight/daylight_results.hpp"

namespace exitance {

/// Compares a simulation with the conditions of LM-83 [LM83]: a whole year, 8 to 18 h of every day, 300 lx, points at
/// most 0.61 m (2 ft) apart, and for sDA blinds of every pane that close in each hour in which more than 2% of the
/// points have direct sunlight. Conditions on the model itself, such as furniture and obstructions, are not checked.
/// `is_computed`: false for coefficients of another program, which have no direct sunlight. O(sensors).
Lm83Deviations lm83_deviations(const DaylightTask& task, bool is_computed);

}  // namespace exitance

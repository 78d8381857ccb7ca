#pragma once

#include <algorithm>

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// R, the limit on the error of every row: default, and limits for programs and users. Derived from three significant
/// digits of a row, from the rounding of contour integrals, which are accurate to 1e-4 of the smallest, and from half
/// of a row.
inline constexpr double default_row_error = 1e-3, min_row_error = 1e-7, max_row_error = 0.5;

/// Relative error of every entry above `smallest_entry`: default, and limits for programs and users. The least one is
/// derived from double precision.
inline constexpr double default_entry_error = 1e-4, min_entry_error = 1e-12, max_entry_error = 0.1;

/// Entries below need no relative accuracy. Derived from default_row_error: a thousand of them are as much.
inline constexpr double smallest_entry = 1e-6;

/// Differences within this number of standard deviations are noise. Derived from the normal distribution: one in 2,000
/// exceeds it by chance.
inline constexpr double max_noise_deviations = 3.5;

/// Distance of a point from a plane, metres, up to which it lies in the plane. Derived from the rounding of coordinates
/// in files with eight digits.
inline double plane_slack(const Occluders& occluders) {
    constexpr double share = 1e-8;  // of the scene's size; derived from such files
    return std::max(share * occluders.scene().size(), occluders.rounding());
}

}  // namespace exitance

#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/random.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/row_scene.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct RowCheckOptions {
    std::size_t rows = 4;         ///< Chosen at random from the finished rows, without repetition.
    std::size_t rays = 1u << 17;  ///< Number of rays for each half of a row.
    std::size_t groups = 16;      ///< Random groups of neighbouring faces per row.
    std::uint64_t seed = 1;
    double error = default_row_error;  ///< R, allowed error of every row.
};

/// Comparison of one row F with independent rays in two halves, G1 and G2.
struct CheckedRow {
    std::size_t face = 0;
    double squared_error = 0;  ///< sum_j (F - G1)_j (F - G2)_j, an unbiased estimate of the squared error of the row.
    double squared_error_deviation = 0;  ///< Standard error of `squared_error`.
    /// Maximum over x of (|sum_j (F - G)_j x_j| - R) in standard errors, for x = 1 and for the indicators of the
    /// groups.
    double largest_sum_excess = 0;
    double largest_sum_error = 0;      ///< Maximum over x of |sum_j (F - G)_j x_j|, including the noise of the rays.
    double largest_sum_deviation = 0;  ///< Maximum over x of the standard error of that sum.
    /// Excess of the squared error over R^2 in standard errors; negative if it is below.
    double squared_excess(double R) const { return (squared_error - R * R) / squared_error_deviation; }
    /// Smallest error of the row that the rays distinguish from R, by `deviations` standard errors of the squared
    /// error.
    double detectable(double R, double deviations) const {
        return std::sqrt(R * R + deviations * squared_error_deviation);
    }
};

/// Result of checking rows by rays. A table of zeros would pass checks of entries, but fails those of sums over rows
/// and groups.
struct RowCheck {
    std::vector<CheckedRow> rows;
    std::size_t rays = 0;  ///< Rays of all rows together.
    /// Number of rows whose squared error exceeds R^2, or of which a sum exceeds R, by more than max_noise_deviations
    /// standard deviations.
    std::size_t wrong = 0;
    std::size_t wrong_sums = 0;   ///< Like `wrong`, for the error of a sum over the row or a group.
    double error = 0;             ///< Root mean squared error of the rows; 0 if noise makes the mean negative.
    double sum_error = 0;         ///< Largest difference of a sum over a row or group, including the noise of the rays.
    double detectable_error = 0;  ///< Least error that would have been found in every row.
    double detectable_sum = 0;    ///< Like detectable_error, for the error of a sum over a row or group.
    bool is_complete = true;      ///< False if a stop was requested before the last row.
};

/// Returns the shares of pseudo-random rays from a face that hit each front first, for checks.
std::vector<double> cast_check_rays(const RowScene& ready, std::size_t face, std::size_t rays, RandomStream random,
                                    const StopRequest& stop);

/// Checks random rows with independent pseudo-random rays. Deterministic on any number of threads. About 0.3 us per
/// ray.
RowCheck check_rows_by_rays(const Scene& scene, const SparseFactors& table, const RowCheckOptions& options,
                            const StopRequest& stop);

/// Like the above, for rows in any form.
/// finished  1 for each row that exists
/// row_of  returns a row, one factor per face; called from several threads
RowCheck check_rows_by_rays(const Scene& scene, std::span<const std::uint8_t> finished,
                            const std::function<std::vector<double>(std::size_t)>& row_of,
                            const RowCheckOptions& options, const StopRequest& stop);

}  // namespace exitance

#pragma once

#include <cstdint>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct RowCheckOptions {
    std::size_t rows = 4;         ///< Drawn at random among the finished ones, none twice.
    std::size_t rays = 1u << 17;  ///< A half of a row.
    std::size_t groups = 16;      ///< Random groups of neighbouring faces, per row.
    std::uint64_t seed = 1;
    double error = 1e-3;  ///< R of every row.
};

/// One row F against independent rays in two halves, G1 and G2.
struct CheckedRow {
    std::size_t face = 0;
    double squared_error = 0;            ///< sum_j (F - G1)_j (F - G2)_j: unbiased for the squared error of the row.
    double squared_error_deviation = 0;  ///< Its standard error.
    /// max over x of (|sum_j (F - G)_j x_j| - R) in standard errors, for x = 1 and x of the groups.
    double largest_sum_excess = 0;
    /// Standard errors by which the squared error is above R^2; below 0 where it is not.
    double squared_excess(double R) const { return (squared_error - R * R) / squared_error_deviation; }
};

/// What rays say about rows. Entry-wise checks pass a table of zeros; sums over rows and groups do not.
struct RowCheck {
    std::vector<CheckedRow> rows;
    std::size_t rays = 0;     ///< In all.
    std::size_t wrong = 0;    ///< Rows for which either excess is above `beyond_noise`.
    double error = 0;         ///< Root of the mean squared error of the rows, 0 where noise made it negative.
    bool is_complete = true;  ///< False: stopped before the last row.
    static constexpr double beyond_noise = 3.5;
};

/// Checks random rows with independent pseudo-random rays. The same on any number of threads. About 0.3 us a ray.
RowCheck check_rows_by_rays(const Scene& scene, const SparseFactors& table, const RowCheckOptions& options,
                            const StopRequest& stop);

}  // namespace exitance

#pragma once

#include <cstdint>
#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/raw_row_store.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Standard deviations that a normal variable exceeds in one case of 100; derived from its distribution.
inline constexpr double one_row_in_a_hundred = 2.33;

struct RowFactorOptions {
    double error = default_row_error;  ///< R: limit for every row on its error, with its bounds.
    /// Rows exceed R as rarely as a normal variable exceeds its mean by that many standard deviations, both in the root
    /// of their squared error and in sums over groups of faces: see ClosedVariance::limit(). 0: R limits sqrt(sum of
    /// variances), which half of all rows exceed.
    double deviations = one_row_in_a_hundred;
    double smallest = 0;  ///< Smaller entries are dropped; their sum is added to their row's error.
    /// Limit on the standard deviations of the shares of the sky and of backs; empty: `error`. If they are off by d, so
    /// is the row's sum, since rows are closed.
    std::optional<double> missed_error = {};
    std::uint64_t seed = 1;
    std::size_t memory_limit_bytes = SIZE_MAX;  ///< Computation of rows stops if the process uses more.
};

/// Computes view factors between all faces of a scene with a given error of every row, in two passes: each row
/// independently (RowEstimator), then the two estimates of every pair are combined (combine_rows). Faces block light
/// from both sides and receive it at their front. If a stop is requested or the memory limit is reached, returns the
/// finished rows without combining them. The result has the same bits on any number of threads and, with `store`, after
/// any number of interruptions. Memory is proportional to the number of entries.
SparseFactors compute_row_factors(const Scene& scene, const RowFactorOptions& options, RawRowStore* store,
                                  Progress& progress, const StopRequest& stop);

}  // namespace exitance

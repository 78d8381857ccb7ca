#pragma once

#include <cstdint>

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/raw_row_store.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct RowFactorOptions {
    double error = 1e-3;  ///< R: for every row sqrt(sum of variances) + sum of bounds.
    double smallest = 0;  ///< Entries below are dropped, and their sum counts in their row's error.
    std::uint64_t seed = 1;
    std::size_t memory_limit_bytes = SIZE_MAX;  ///< Rows end when the process holds more.
};

/// Computes view factors between all faces of a scene to an error of every row, in two passes: rows by themselves
/// (RowEstimator), then both estimates of every pair combined (combine_rows). A face blocks from both sides and is seen
/// from its front. When a stop is requested or memory runs out, returns the finished rows, not combined. The same bits
/// on any number of threads, and after any number of interruptions with `store`. Memory is in proportion to the number
/// of entries.
SparseFactors compute_row_factors(const Scene& scene, const RowFactorOptions& options, RawRowStore* store,
                                  Progress& progress, const StopRequest& stop);

}  // namespace exitance

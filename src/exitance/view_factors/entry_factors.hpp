#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/raw_row_store.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct EntryFactorOptions {
    double tolerance = 1e-4;                    ///< Relative error of every entry above 1e-6.
    double smallest = 0;                        ///< Entries below are dropped.
    std::size_t memory_limit_bytes = SIZE_MAX;  ///< Rows end when the process holds more.
};

/// compute_view_factors with rows that outlive a stop: finished rows are kept in `store`, and returned when a stop is
/// requested or memory runs out. `is_settled` is false then, and so it is if pairs of rows that disagree were not all
/// computed again. Memory: 8 bytes a pair, and the entries.
SparseFactors compute_entry_factors(const Scene& scene, const EntryFactorOptions& options, RawRowStore* store,
                                    Progress& progress, const StopRequest& stop);

}  // namespace exitance

#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/raw_row_store.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct EntryFactorOptions {
    /// Relative error of every entry above smallest_entry; min_entry_error to max_entry_error.
    double tolerance = default_entry_error;
    double smallest = 0;                        ///< Entries below this are dropped.
    std::size_t memory_limit_bytes = SIZE_MAX;  ///< Computation of rows stops if the process uses more.
};

/// Computes all view factors of a scene. Faces are treated individually, and rows are not normalized. Faces block light
/// from both sides and receive it at their front. Rows are computed in parallel, each from points of its own receiver.
/// If two rows disagree on a pair of faces, both entries are recomputed more accurately. Deterministic on any number of
/// threads.
///
/// Rows survive a stop: finished rows are saved in `store` (if not null) and returned if a stop is requested or the
/// memory limit is reached. `is_settled` is false in that case, and also if not all pairs of rows that disagree could
/// be recomputed. Memory: 8 bytes per pair, plus the entries.
SparseFactors compute_entry_factors(const Scene& scene, const EntryFactorOptions& options, RawRowStore* store,
                                    Progress& progress, const StopRequest& stop);

}  // namespace exitance

#pragma once

#include <cstddef>
#include <vector>

#include "exitance/base/check.hpp"
#include "exitance/view_factors/entry_factors.hpp"

namespace exitance {

/// Returns all view factors of a scene as a full matrix. `tolerance`: relative error of every entry above 1e-6.
inline ViewFactors dense_view_factors(const Scene& scene, double tolerance) {
    Progress progress;
    const SparseFactors sparse =
        compute_entry_factors(scene, {.tolerance = tolerance}, nullptr, progress, StopRequest());
    EXI_CHECK(sparse.is_settled);
    ViewFactors out{.areas = sparse.areas,
                    .emittances = sparse.emittances,
                    .factors = std::vector<double>(sparse.size() * sparse.size()),
                    .row_sums = sparse.row_sums,
                    .reciprocity_defect = sparse.reciprocity_defect,
                    .entry_defect = sparse.entry_defect,
                    .mended = sparse.mended,
                    .unsettled = sparse.unsettled};
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t k = sparse.starts[i]; k < sparse.starts[i + 1]; ++k)
            out.factors[i * out.size() + sparse.columns[k]] = sparse.values[k];
    return out;
}

}  // namespace exitance

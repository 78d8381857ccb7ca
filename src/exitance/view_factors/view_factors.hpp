#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// View factors between all faces of a scene, in the order of its file. Row i gathers: F_ij is the share of the diffuse
/// flux leaving face i that reaches the front of face j directly.
struct ViewFactors {
    std::vector<double> areas;       ///< m^2, one a face.
    std::vector<double> emittances;  ///< 1 - reflectance, mean over the bands, one a face.
    std::vector<double> factors;     ///< n x n, row by row, each in [0, 1].
    std::vector<double> row_sums;    ///< Never adjusted: 1 but for the error in a closed scene.
    /// max |A_i F_ij - A_j F_ji| / (A_i max_j F_ij). Rows are computed independently, so it measures their error.
    double reciprocity_defect = 0;
    /// max |A_i F_ij - A_j F_ji| / max(A_i F_ij, A_j F_ji) over pairs with an entry above 1e-6.
    double entry_defect = 0;
    std::size_t mended = 0;     ///< Pairs of faces whose rows disagreed at first, and were looked at again.
    std::size_t unsettled = 0;  ///< Those that still disagree by more than the tolerance.

    static constexpr double smallest_entry = 1e-6;  ///< What lies below needs no digits of its own.

    std::size_t size() const { return areas.size(); }
    std::span<const double> row(std::size_t i) const { return std::span(factors).subspan(i * size(), size()); }
};

/// All view factors of a scene; every face by itself, never merged, rows never forced to sum to one. A face blocks from
/// both sides and is seen from its front. Rows are computed in parallel, each from points of its own receiver; where
/// two rows disagree on a pair of faces, both entries are computed again, more closely. The same on any number of
/// threads. tolerance  relative error asked for of every entry above 1e-6; 1e-12 to 0.1 returns an error of code
/// `limit` when a stop is requested before the last row is done. Memory: 8 bytes a pair.
Result<ViewFactors> compute_view_factors(const Scene& scene, double tolerance, Progress& progress,
                                         const StopRequest& stop);

}  // namespace exitance

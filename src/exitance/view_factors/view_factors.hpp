#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace exitance {

/// View factors between all faces of a scene as a full matrix, in the order of its file. Row i is for gathering: F_ij
/// is the share of the diffuse flux leaving face i that reaches the front of face j directly.
struct ViewFactors {
    std::vector<double> areas;       ///< Area of every face, m^2.
    std::vector<double> emittances;  ///< 1 - reflectance, mean over the bands, one per face.
    std::vector<double> factors;     ///< The n x n factors, row by row, each in [0, 1].
    std::vector<double> row_sums;    ///< Never normalized: 1 up to the error in a closed scene.
    /// max |A_i F_ij - A_j F_ji| / (A_i max_j F_ij). Measures the error of rows, since they are computed independently.
    double reciprocity_defect = 0;
    /// max |A_i F_ij - A_j F_ji| / max(A_i F_ij, A_j F_ji) over pairs with an entry above 1e-6.
    double entry_defect = 0;
    std::size_t mended = 0;     ///< Number of pairs of faces whose rows disagreed at first and were recomputed.
    std::size_t unsettled = 0;  ///< Number of pairs that still disagree by more than the tolerance.

    std::size_t size() const { return areas.size(); }
    std::span<const double> row(std::size_t i) const { return std::span(factors).subspan(i * size(), size()); }
};

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/raw_row.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct CombineOptions {
    double smallest = 0;    ///< Entries below this are dropped.
    double deviations = 0;  ///< See ClosedVariance::limit().
    double error =
        default_row_error;  ///< R; closure defects are computed for rows with at most this error of the missed share.
};

/// Combines the two estimates of every pair of faces, weighted by their numbers of samples. These were fixed before
/// sampling, so that the result is unbiased:
///
///     A_i F_ij = A_j F_ji = (q_ij A_i F_ij + q_ji A_j F_ji) / (q_ij + q_ji),   q samples per m^2.
///
/// For rows of rays this is (h_ij + h_ji) / (n_i / A_i + n_j / A_j). If a row's closure defect is explained by its
/// variance, it is distributed over the entries: by the smallest change, relative to the variances, that closes all
/// rows and keeps reciprocity. Sets all of `out` except areas and emittances. Memory: that of the rows, half of it
/// again, and the result. rows  one per face, in order; entries of 0 are added so that each pair has two or none
/// Returns per row the limit that its error exceeds rarely (ClosedVariance::limit), with its bounds.
std::vector<double> combine_rows(std::vector<RawRow>& rows, const CombineOptions& options, SparseFactors& out);

/// Stores the finished rows without combining them.
/// rows      one per face, in order
/// finished  1 for each row that exists
void store_raw_rows(const std::vector<RawRow>& rows, const std::vector<std::uint8_t>& finished,
                    const CombineOptions& options, SparseFactors& out);

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/view_factors/raw_row.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

struct CombineOptions {
    double smallest = 0;  ///< Entries below are dropped.
    double error = 1e-3;  ///< R, for which rows the closure defect is known.
};

/// Combines the two estimates of every pair of faces by their numbers of samples, which were known before they were
/// drawn, so that the result is unbiased:
///
///     A_i F_ij = A_j F_ji = (q_ij A_i F_ij + q_ji A_j F_ji) / (q_ij + q_ji),   q samples per m^2.
///
/// For rows of rays that is (h_ij + h_ji) / (n_i / A_i + n_j / A_j). The closure defect of a row, if its variance
/// explains it, is then distributed over the entries: the smallest change, relative to the variances, that closes all
/// rows and keeps reciprocity. Sets all of `out` but areas and emittances. Memory: twice that of the rows.
/// rows  one a face, in order
void combine_rows(const std::vector<RawRow>& rows, const CombineOptions& options, SparseFactors& out);

/// Stores the rows that are finished as they are. rows  one a face, in order; `finished` tells which exist
void store_raw_rows(const std::vector<RawRow>& rows, const std::vector<std::uint8_t>& finished,
                    const CombineOptions& options, SparseFactors& out);

}  // namespace exitance

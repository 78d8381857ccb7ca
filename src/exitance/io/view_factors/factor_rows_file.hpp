#pragma once

#include <cstdint>
#include <string>

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Writes the rows of a table into a group that exists: `indptr`, `indices` and `data` as in SciPy's compressed rows,
/// and one number per row of areas, emittances, sums, errors, and shares of the sky and of backs.
void write_factor_rows(Hdf5Writer& file, const std::string& group, const SparseFactors& table);

/// Reads rows that write_factor_rows() has written.
SparseFactors read_factor_rows(Hdf5Reader& file, const std::string& group, std::size_t further_columns);

/// Error (bad_input) if the attribute `version` of a group is above `known`. Files without one are of version 1.
Result<void> check_file_version(Hdf5Reader& file, const std::string& group, std::int64_t known,
                                const std::string& path);

}  // namespace exitance

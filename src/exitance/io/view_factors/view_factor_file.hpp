#pragma once

#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Writes view factors in the format that the path's ending selects: `.vf` is View3D's text format, `.mtx` Matrix
/// Market's coordinate format and `.h5` HDF5, the last two without zeros; all other endings are CSV. Unfinished rows
/// are omitted from CSV and empty in the other formats. The file appears whole or not at all.
/// Errors: ErrorCode::limit if a stop is requested, ErrorCode::cannot_write.
Result<void> write_view_factors(const std::string& path, const SparseFactors& table, const StopRequest& stop);

/// Reads a `.h5` file of write_view_factors().
Result<SparseFactors> read_view_factors(const std::string& path);

/// Formats a table as CSV: a header `surface,area,row_sum,F_1,...,F_n`, then one row per face, numbered from 1 in the
/// order of the scene file. With 17 digits, reading restores the same doubles.
std::string view_factors_csv(const SparseFactors& table);

/// Formats a table as View3D's text output: a header of 30 characters, areas (%g), rows (%.6f: error up to 5e-7),
/// emittances (%.3f).
std::string view_factors_vf(const SparseFactors& table);

/// Formats a table as Matrix Market `coordinate real general`: areas as comments, then one line `i j F_ij` (17 digits)
/// per entry above 0.
std::string view_factors_mtx(const SparseFactors& table);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Writes view factors as the path's ending says: `.vf` as View3D's text format, `.mtx` as Matrix Market's coordinates
/// and `.h5` as HDF5, both without zeros, anything else as CSV. Rows that are not finished are left out of CSV and
/// empty in the others. The file appears whole or not at all: not when a stop is requested (ErrorCode::limit) or it
/// cannot be written (ErrorCode::cannot_write).
Result<void> write_view_factors(const std::string& path, const SparseFactors& table, const StopRequest& stop);

/// Reads a table from a `.h5` file of write_view_factors.
Result<SparseFactors> read_view_factors(const std::string& path);

/// Header `surface,area,row_sum,F_1,...,F_n`, then a row a face, numbered from 1 in the order of the scene's file;
/// 17 digits, which give the same doubles back.
std::string view_factors_csv(const SparseFactors& table);

/// View3D's text output: a header of 30 characters, areas (%g), rows (%.6f: precise to 5e-7), emittances (%.3f).
std::string view_factors_vf(const SparseFactors& table);

/// Matrix Market, `coordinate real general`: areas as comments, then a line `i j F_ij` (17 digits) an entry above 0.
std::string view_factors_mtx(const SparseFactors& table);

}  // namespace exitance

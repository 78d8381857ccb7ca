#pragma once

#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"

namespace exitance {

/// The networks of growing cells in a solution's file. Readers check every count and index: unless `file.failed()`,
/// what they return is safe to use.
void write_cells(Hdf5Writer& file, const std::string& group, const Solution& solution);
void read_cells(Hdf5Reader& file, const std::string& group, Solution& solution);

}  // namespace exitance

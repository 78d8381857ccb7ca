#pragma once

#include <string>

#include "exitance/io/files/rehearsal.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

struct LightGroups;

/// Whether a solution's file holds the group /VTKHDF for other programs.
enum class VtkGroup : std::uint8_t { written, left_out };

/// Writes a solution as HDF5: /VTKHDF for other programs, and /exitance, from which it is restored bit for bit. Equal
/// solutions give equal files, except for /exitance/statistics. Solutions with layers and without light groups have no
/// /VTKHDF and no elements of the export, which follow from the layers. Light groups are included if `groups` is not
/// null. The file appears whole or not at all. Error: ErrorCode::cannot_write.
Result<void> write_solution(const std::string& path, const Solution& solution, const LightGroups* groups = nullptr,
                            VtkGroup vtk = VtkGroup::written);

/// Reads a file of write_solution(), with its light groups if `groups` is not null. Error: ErrorCode::cannot_read if
/// the file cannot be opened; ErrorCode::bad_input for a damaged or forged file, naming the file and the data set.
Result<Solution> load_solution(const std::string& path, Rehearsed rehearsed = Rehearsed::not_yet,
                               LightGroups* groups = nullptr);

}  // namespace exitance

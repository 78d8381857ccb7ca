#pragma once

#include <string>

#include "exitance/io/files/rehearsal.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

struct LightGroups;

/// Writes a solution as HDF5: /VTKHDF for other programs, /exitance to come back from bit for bit. Equal solutions give
/// equal files but for /exitance/statistics. The file appears whole or not at all (ErrorCode::cannot_write).
/// `groups` go with it where there are any.
Result<void> write_solution(const std::string& path, const Solution& solution, const LightGroups* groups = nullptr);

/// Reads what write_solution wrote. A file that is damaged, or made up, is an error (ErrorCode::bad_input, or
/// ErrorCode::cannot_read when it cannot be opened) that names the file and the data set.
/// Its light groups, if it has any, are read where they are asked for.
Result<Solution> load_solution(const std::string& path, Rehearsed rehearsed = Rehearsed::not_yet,
                               LightGroups* groups = nullptr);

}  // namespace exitance

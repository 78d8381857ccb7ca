#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// Reads reference points from a CSV file with the columns x,y,z,nx,ny,nz, E_* and, optionally, se_*.
Result<ReferencePoints> load_reference_points(const std::string& path);

/// Writes reference points in the same format, with se_* if there are standard errors.
Result<void> write_reference_points(const std::string& path, const ReferencePoints& reference);

}  // namespace exitance

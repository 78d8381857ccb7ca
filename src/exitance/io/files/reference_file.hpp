#pragma once

#include <string>

#include "exitance/base/result.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// Reads a CSV with x,y,z,nx,ny,nz, E_* and, where given, se_*.
Result<ReferencePoints> load_reference_points(const std::string& path);

/// Writes one, with se_* where there are standard errors.
Result<void> write_reference_points(const std::string& path, const ReferencePoints& reference);

}  // namespace exitance

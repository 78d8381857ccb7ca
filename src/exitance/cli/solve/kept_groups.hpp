#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// The error for a solution without light groups, of a verb that needs them.
Error no_light_groups(const std::string& solution_file);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Returns the error of a verb that needs light groups, for a solution without them.
Error no_light_groups(const std::string& solution_file);

}  // namespace exitance

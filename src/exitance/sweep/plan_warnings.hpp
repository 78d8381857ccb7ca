#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// Likely mistakes in a plan that can be run: parameters that no command and no template uses, and variants whose
/// parameters are equal. Error: cannot_read, for a template.
Result<std::vector<std::string>> plan_warnings(const SweepPlan& plan);

}  // namespace exitance

#pragma once

#include "exitance/base/result.hpp"
#include "exitance/sweep/resolved_step.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// Makes the folder of a finished variant: links to the files of its steps, `STEP.stdout.txt` for what they print, and
/// `variant.json`. The folder appears whole; an older one is replaced if the variant has changed. Error: cannot_write.
Result<void> link_variant(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant);

}  // namespace exitance

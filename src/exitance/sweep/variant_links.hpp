#pragma once

#include "exitance/base/result.hpp"
#include "exitance/sweep/resolved_step.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// Makes the folder of a finished variant: links to the files of its steps, `STEP.stdout.txt` for their output, and
/// `variant.json`. The folder appears whole; an older one is replaced if the variant has changed or a link is broken.
/// Files that the user put into it stay. Error: cannot_write.
Result<void> link_variant(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant);
/// Removes the folder of a variant if it was made for other parameters or inputs. Files of the user stay.
void remove_if_stale(const SweepPlan& plan, std::size_t index, const ResolvedVariant& variant);
/// Removes folders that this plan made for variants that it no longer has. Files of the user stay.
void remove_extra_variants(const SweepPlan& plan);

}  // namespace exitance

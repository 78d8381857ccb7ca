#pragma once

#include <string>
#include <vector>

#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

class TomlKeys;

/// Settings of some parameters, each of which is combined with each of the other blocks.
using SweepBlock = std::vector<SweepSetting>;

/// Reads a table `[[vary]]` of a plan: lists of values, rows, or a CSV file relative to the folder `base`. Throws
/// WrongToml.
SweepBlock read_block(TomlKeys& keys, const std::string& base);
/// Combines a block, which the table `keys` describes, with the plan's variants. Throws WrongToml.
void add_block(const TomlKeys& keys, const SweepBlock& block, SweepPlan& plan);

}  // namespace exitance

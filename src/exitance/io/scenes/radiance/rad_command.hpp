#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

using CommandWords = std::vector<std::string>;

/// Splits a command of a Radiance file, such as "genbox a b 1 2 3 | xform -t 1 0 0", into its programs with their
/// arguments. Words may be quoted. Error: characters with a meaning to shells (;, <, >, &, $, `, \\ and patterns of
/// file names).
Result<std::vector<CommandWords>> parse_command(std::string_view command);

}  // namespace exitance

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

using CommandWords = std::vector<std::string>;

/// The programs of a command in a Radiance file, each with its arguments: "genbox a b 1 2 3 | xform -t 1 0 0". Words
/// may stand in quotes. What only a shell understands (;, <, >, &, $, `, \\ and patterns of file names) is an error.
Result<std::vector<CommandWords>> parse_command(std::string_view command);

}  // namespace exitance

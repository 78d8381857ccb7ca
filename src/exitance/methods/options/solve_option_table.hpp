#pragma once

#include <span>
#include <string>

#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// The table of options that control a solve. The parser, help, errors about unsupported options, recorded options,
/// manual page, shell completions and docs/options.md are generated from it. A new option is a new row.
std::span<const OptionRow> solve_option_table();

/// The row of an option, such as "--epsilon"; null if there is none.
const OptionRow* find_option(std::string_view name);

/// JSON object with every recorded option of a request.
std::string recorded_options(const SolveRequest& request);

}  // namespace exitance

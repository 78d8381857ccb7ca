#pragma once

#include <span>
#include <string>

#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// The table of options that decide how a solve is done. Parser, help, refusals, recorded options, manual page, shell
/// completion and docs/options.md are made from it. A new option is a new row.
std::span<const OptionRow> solve_option_table();

/// The row of "--epsilon"; null if there is none.
const OptionRow* find_option(std::string_view name);

/// JSON object with every recorded option of a request.
std::string recorded_options(const SolveRequest& request);

}  // namespace exitance

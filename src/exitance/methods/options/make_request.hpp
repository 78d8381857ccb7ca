#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// An option of the command line and the word after it; empty for flags.
struct GivenOption {
    const OptionRow* row;
    std::string word;
};

/// Builds a request from options in any order. Presets of a recipe are applied first, so that options replace them. Old
/// names are accepted with a warning. Error (usage): an option has a wrong value, or options cannot be combined.
/// Support by methods is checked by find_method_form().
Result<SolveRequest> make_request(std::span<const GivenOption> given);

/// Sets the options that others imply: gather and smoothing for --output-light, exact direct light of the published
/// form for --visibility exact. Moves the threshold to the member that --task-engine reads.
void settle(SolveRequest& request);

}  // namespace exitance

#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/methods/options/option_row.hpp"

namespace exitance {

/// An option of the command line, with the word that follows it; flags have none.
struct GivenOption {
    const OptionRow* row;
    std::string word;
};

/// The request that options make, in any order. Presets of a recipe come first, so that options replace them; old names
/// become new ones, with a warning. Errors (usage) say which option has a wrong value, or which cannot be combined.
/// Support by methods is checked by find_way().
Result<SolveRequest> make_request(std::span<const GivenOption> given);

/// Lets options that imply others set them: --output-light the gather and the smoothing, --visibility exact the
/// published form, --task-engine where the threshold is kept.
void settle(SolveRequest& request);

}  // namespace exitance

#pragma once

#include <span>

#include "exitance/base/result.hpp"
#include "exitance/cli/arguments.hpp"

namespace exitance {

/// An option, and whether it was given.
struct GivenOption {
    const char* name;
    bool is_given;
};

/// An error for the first one that is given; `form` does not obey any of them.
Result<void> refuse_given(std::span<const GivenOption> options, const char* form, const char* hint);

/// Options that the methods obey and forms of them with a path of their own do not.
std::vector<GivenOption> options_of_methods(const SolveArguments& arguments);

}  // namespace exitance

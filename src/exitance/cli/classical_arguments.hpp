#pragma once

#include <functional>
#include <span>
#include <string>

#include "exitance/cli/arguments.hpp"

namespace exitance {

/// An option of `solve` that chooses or belongs to a method's classical form.
struct ClassicalArgument {
    std::string name, type;  ///< `--name`, and its values; without values it is a flag.
    std::string group, help;
    /// Reads the word that follows it; says what is wrong with it, or nothing.
    std::function<std::string(const std::string& word, SolveArguments& arguments)> read;
};

/// All of them, in the order in which --help lists them.
std::span<const ClassicalArgument> classical_arguments();

}  // namespace exitance

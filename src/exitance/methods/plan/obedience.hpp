#pragma once

#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// An option that is set and that not every method obeys.
struct AskedOption {
    const char* name;
    std::vector<Method> methods;  ///< Those that obey it, in the order in which `auto` tries them.
    const char* hint = "";        ///< What it goes with in a method that obeys some of its values alone.
};

/// All options that are set and that not every method obeys. Forms with a path of their own (the papers', tasks, local
/// passes a to d) have lists of their own.
std::vector<AskedOption> asked_of_methods(const SolveOptions& options);

/// Does the method, or where reflections are counted the one that takes its place, obey all that is set?
bool obeys_all(Method method, const SolveOptions& options);

/// The first method that obeys all that is set, for `auto`; `automatic` where none does.
Method first_that_obeys(const SolveOptions& options);

/// A usage error for the first option that the method asked for does not obey, with the methods that do.
Result<void> check_obedience(const SolveOptions& options);

}  // namespace exitance

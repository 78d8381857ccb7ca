#pragma once

#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// An option that is set and that is not supported by every method.
struct AskedOption {
    const char* name;
    std::vector<Method> methods;  ///< Methods that support it, in the order in which `auto` tries them.
    const char* hint = "";        ///< Required combination in a method that supports only some values.
};

/// Returns all set options that some method does not support. Forms with a path of their own (those of the papers,
/// tasks, local passes a to d) have separate lists.
std::vector<AskedOption> asked_of_methods(const SolveOptions& options);

/// True if the method supports all set options. If the number of reflections is limited, this is tested for the method
/// that replaces it.
bool obeys_all(Method method, const SolveOptions& options);

/// Returns the first method that supports all set options, for `auto`; `automatic` if there is none.
Method first_that_obeys(const SolveOptions& options);

/// Returns a usage error for the first option that the requested method does not support; the error lists the methods
/// that do.
Result<void> check_obedience(const SolveOptions& options);

}  // namespace exitance

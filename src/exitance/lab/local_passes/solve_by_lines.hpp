#pragma once

#include "exitance/lab/local_passes/line_hierarchy.hpp"
#include "exitance/methods/method_entry.hpp"

namespace exitance {

/// The method of `--method discontinuity --local-pass a|b|c|d`: global and local pass as published (LineHierarchy,
/// run_local_pass). Links transport the light of emitters as well. The result is a function on quadratic triangles,
/// which is exported as it is. The mesh of the result is a coarse one, from which the certificate computes how errors
/// propagate.
GlobalLight solve_by_lines(const MethodInput& input);

/// Returns the hierarchy's settings for a relative error: rules of thumb that the error estimate checks.
LineHierarchyOptions line_options(const SolveOptions& options, double error);

}  // namespace exitance

#pragma once

#include "exitance/base/result.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Bytes that a method takes for its entries, links, columns or networks when it solves on so many leaves; at its peak,
/// and an upper estimate. Trees and light of the leaves are not among them (bytes_a_leaf).
double method_bytes(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves);

/// Checks, before the method starts, that this fits beside what the process holds: into --memory-limit or, without one,
/// into the memory that the machine has available. The error is of code `limit` and names what is needed. All.
Result<void> check_method_memory(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves);

}  // namespace exitance

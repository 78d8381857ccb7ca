#pragma once

#include "exitance/base/result.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Returns an upper estimate of the peak memory of a method for its entries, links, columns or networks on this many
/// leaves, bytes. Excludes trees and light of the leaves (`bytes_a_leaf`).
double method_bytes(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves);

/// Checks before the method starts that this memory is available in addition to that in use: within --memory-limit, or
/// without a limit, within the available memory of the machine. The error has code `limit` and states the memory
/// needed. Collective.
Result<void> check_method_memory(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double leaves);

}  // namespace exitance

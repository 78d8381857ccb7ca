#pragma once

#include "exitance/accuracy/accuracy.hpp"
#include "exitance/core/result.hpp"

namespace exitance {

/// Coarsens the knobs until what they will need, on top of what is in use, fits into the options' memory limit. True
/// when nothing had to be changed; an error when even the coarsest mesh does not fit.
Result<bool> fit_into_memory(Knobs& knobs, const std::vector<Piece>& pieces, const SolveOptions& options);

}  // namespace exitance

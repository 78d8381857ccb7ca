#pragma once

#include "exitance/accuracy/accuracy.hpp"
#include "exitance/core/result.hpp"

namespace exitance {

/// Bytes of a leaf in every vector and tree that it stands in: an office of 12,000 leaves takes 19 MB, of 28,000 30 MB.
constexpr double bytes_a_leaf = 1500;

/// What each of several processes on a node holds for itself, by what one process would hold: the rest they have in
/// common. On `generate complex` of 54,005 polygons, rounded up.
constexpr double own_memory = 0.3;

/// Coarsens the knobs until what they will need, on top of what is in use, fits into the options' memory limit. True
/// when nothing had to be changed; an error when even the coarsest mesh does not fit. The limit is that of a process, and
/// pages that those of a node have in common count for each by its share: n of them need n limits of the node. All.
Result<bool> fit_into_memory(Knobs& knobs, const std::vector<Piece>& pieces, const SolveOptions& options);

}  // namespace exitance

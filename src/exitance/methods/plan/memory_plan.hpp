#pragma once

#include "exitance/base/result.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Bytes of a leaf, of direct light or of the gather, in every vector and tree that it stands in: 460 to 1,350 in rooms
/// of 20 to 54,005 polygons at 2% and 5%, 820 where they are most.
constexpr double bytes_a_leaf = 1000;

/// What each of several processes on a node has of these for itself; the rest they have in common. Given by `generate
/// complex` of 54,005 polygons in two processes, 0.14.
constexpr double own_memory = 0.15;

/// Coarsens the knobs until what they will need, on top of what is in use, fits into the options' memory limit. True
/// when nothing had to be changed; an error when even the coarsest mesh does not fit. The limit is that of a process,
/// and pages that those of a node have in common count for each by its share: n of them need n limits of the node. All.
Result<bool> fit_into_memory(Knobs& knobs, const Stage& stage, const SolveOptions& options);

}  // namespace exitance

#pragma once

#include "exitance/base/result.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Memory per leaf of direct light or of the gather in all vectors and trees, bytes. Measured 460 to 1,350 in rooms of
/// 20 to 54,005 polygons at 2% and 5%, 820 for the largest numbers of leaves.
constexpr double bytes_a_leaf = 1000;

/// Share of this memory that each of several processes on a node needs for itself; the rest is shared. Rounded up from
/// 0.14, measured in two processes with `generate complex` of 54,005 polygons.
constexpr double own_memory = 0.15;

/// Coarsens the settings until the predicted memory, in addition to that in use, is within the options' memory limit.
/// Returns true if nothing was changed. Error if even the coarsest mesh is too large. The limit applies per process,
/// where shared memory counts for each of n processes on a node with a share of 1 / n. Collective.
Result<bool> fit_into_memory(Knobs& knobs, const Stage& stage, const SolveOptions& options);

}  // namespace exitance

#pragma once

#include "exitance/core/checkpoint.hpp"
#include "exitance/reconstruct/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// The whole job: scene to solution, which takes the scene with it.
///
/// A method finds the light that each element reflects; the local pass gathers it into a function; the certificate says
/// how far that function is from the truth. While it is farther than the error asked for, the knobs are tightened and
/// the three run again. Direct light stands apart and is exact.
/// Missing the error asked for is a finding in the statistics (`converged`, `stopped_by`), not an error; an Error means
/// that there is no result at all.
///
/// With a store for checkpoints, the state is kept from time to time: between the steps of an attempt and between
/// slices of the local pass. A solve that goes on from there gives the same bits, statistics aside, as one that never
/// stopped.
Result<Solution> solve_scene(Scene scene, const SolveOptions& options, Progress& progress, const StopRequest& stop,
                             CheckpointStore* checkpoints = nullptr);

}  // namespace exitance

#pragma once

#include <functional>

#include "exitance/base/checkpoint.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Receives the light that a solve has found so far, with its estimate; it is not converged.
using ShowLight = std::function<void(Solution)>;

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
///
/// `show` is called after every attempt but the last, which is returned. The first attempt then aims at a relative
/// error of 0.32, and each further one, which goes on from what there is, at 0.4 times what was reached, or
/// at the error requested where that is near. Not with checkpoints.
Result<Solution> solve_scene(Scene scene, const SolveOptions& options, Progress& progress, const StopRequest& stop,
                             CheckpointStore* checkpoints = nullptr, const ShowLight& show = {});

}  // namespace exitance

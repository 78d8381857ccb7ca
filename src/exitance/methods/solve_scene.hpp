#pragma once

#include <functional>

#include "exitance/base/checkpoint.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Receives the light that a solve has found so far, with its estimate; it is not converged.
using ShowLight = std::function<void(Solution)>;

/// Solves a scene and returns the solution, which takes over the scene.
///
/// A method finds the light that each element reflects; the local pass gathers it into a function; the certificate
/// estimates the error of that function. While the error is above the requested one, the internal parameters are
/// tightened and the three steps are repeated. Direct light is separate and exact. A missed error is reported in the
/// statistics (`converged`, `stopped_by`). An Error is returned only if there is no result at all.
///
/// Published forms (`form_of`) take the same steps with parts of their own: their mesh, their transport of emitters'
/// light, and a result that is delivered as it is. Most have no certificate; their error estimate is absent.
///
/// If `checkpoints` is given, the state is saved from time to time: between the steps of an attempt and between slices
/// of the local pass. A resumed solve yields the same bits as an uninterrupted one, except for the statistics.
///
/// `show` is called after every attempt except the last, which is returned. The first attempt then aims at a relative
/// error of 0.32 (`recognizable_error`). Each further attempt continues from the last one and aims at 0.4 times its
/// error, or at the requested error if that is near. Not with checkpoints. With a published form, `show` is called when
/// `options.snapshots` says, with the light of the form's elements, before any gather, and without energies. With
/// layers and `options.snapshots`, `show` is called after each source instead, with the layers of the sources so far.
Result<Solution> solve_scene(Scene scene, const SolveOptions& options, Progress& progress, const StopRequest& stop,
                             CheckpointStore* checkpoints = nullptr, const ShowLight& show = {});

}  // namespace exitance

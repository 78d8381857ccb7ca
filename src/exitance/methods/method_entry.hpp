#pragma once

#include "exitance/base/checkpoint.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Input of every method.
struct MethodInput {
    const Stage& stage;
    const SolveOptions& options;
    const Knobs& knobs;
    /// Direct light on elements that follow its shadows. Methods solve on this mesh unless they make their own.
    const DirectProjection& direct;
    Progress& progress;
    const StopRequest& stop;
    /// Checkpoints at which a method of several rounds may save its state.
    SafePoints safe_points = {};
    /// True if an earlier attempt has a result: after a stop, this one may return unfinished, since its result is not
    /// used.
    bool may_give_up = false;
};

/// Finds the reflected light of every element of a mesh. Each method is in a file of its own.
using SolveMethod = GlobalLight (*)(const MethodInput&);

/// Expected cost of a method.
struct MethodForecast {
    double rays = 0, bytes = 0;
};

/// Row of the table of methods.
struct MethodEntry {
    Method id;
    SolveMethod solve;
    const char* basis;  ///< Default basis of its elements.
    /// Cost by a formula of the method's own; null: the engine's, by elements and links. `facing`: share of the pairs
    /// of points that face each other; `blocked`: true if anything lies between any of them.
    MethodForecast (*forecast)(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double facing,
                               bool blocked) = nullptr;
};

}  // namespace exitance

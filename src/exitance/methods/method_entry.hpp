#pragma once

#include "exitance/base/checkpoint.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// What every method is given.
struct MethodInput {
    const Stage& stage;
    const SolveOptions& options;
    const Knobs& knobs;
    /// Direct light on elements that follow its shadows: the mesh that methods solve on, unless they make their own.
    const DirectProjection& direct;
    Progress& progress;
    const StopRequest& stop;
    /// Where a method of several rounds may keep its state between them.
    SafePoints safe_points = {};
    /// Is there light of another attempt? Then a stop may leave this one unfinished: nothing of it is read.
    bool may_give_up = false;
};

/// Finds the reflected light of every element of a mesh that it makes. One file a method.
using SolveMethod = GlobalLight (*)(const MethodInput&);

/// Expected cost of a method.
struct MethodForecast {
    double rays = 0, bytes = 0;
};

/// A row of the table of methods.
struct MethodEntry {
    Method id;
    SolveMethod solve;
    const char* basis;  ///< What its elements hold, when nothing else is asked for.
    /// Cost by a formula of the method's own; null: the engine's, by elements and links. `facing`: share of the pairs
    /// of points that face each other; `blocked`: true if anything lies between any of them.
    MethodForecast (*forecast)(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double facing,
                               bool blocked) = nullptr;
};

}  // namespace exitance

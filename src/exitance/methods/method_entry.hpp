#pragma once

#include "exitance/base/checkpoint.hpp"
#include "exitance/error/tolerance/accuracy.hpp"
#include "exitance/methods/options/method_form.hpp"
#include "exitance/methods/snapshots.hpp"
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
    /// For published forms: the relative error at which this attempt aims, and the receiver of intermediate light.
    double aim = default_error;
    Snapshots* snapshots = nullptr;

    /// Shows the light that `light()` returns if a snapshot is due after a round.
    template <class Light>
    void end_round(const Light& light) const {
        if (snapshots) snapshots->after_round(light);
    }
    /// Like end_round(), after a shot. `shots`: number of shots so far.
    template <class Light>
    void end_shot(std::size_t shots, const Light& light) const {
        if (snapshots) snapshots->after_shot(shots, light);
    }
};

/// Finds the reflected light of every element of a mesh. Each method is in a file of its own.
using SolveMethod = GlobalLight (*)(const MethodInput&);

/// Expected cost of a method.
struct MethodForecast {
    double rays = 0, bytes = 0;
    double elements = 0;  ///< Elements of the own mesh of a published form.
};

/// Forecasts by a formula of the method's own. `facing`: share of the pairs of points that face each other; `blocked`:
/// true if anything lies between any of them.
using ForecastMethod = MethodForecast (*)(const Stage& stage, const SolveOptions& options, const Knobs& knobs,
                                          double facing, bool blocked);

/// Row of the table of methods.
struct MethodEntry {
    Method id;
    SolveMethod solve;
    const char* basis;  ///< Default basis of the method's elements.
    /// Cost by a formula of the method's own; null: the engine's, by elements and links.
    ForecastMethod forecast = nullptr;
    /// In a form other than `standard`, the method makes its own mesh and its own light of emitters, and its light is
    /// delivered as it is, or gathered once if that is requested.
    Form form = Form::standard;
    /// True if the error of the method's light is estimated, so that further attempts may follow.
    bool has_estimate = true;
};

}  // namespace exitance

#pragma once

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/error.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/progress.hpp"
#include "exitance/scene.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/solution.hpp"
#include "exitance/solution/solution.hpp"
#include "exitance/spectrum.hpp"
#include "exitance/vec.hpp"
#include "exitance/view_factors.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance::api {

// Content of the values of the public headers, and conversions between their types and the engine's.

struct SceneData {
    std::shared_ptr<const exitance::Scene> scene;
    std::vector<Finding> findings;
    /// The findings in the engine's type, for the statistics of a solve.
    std::vector<exitance::Finding> engine_findings;
    std::vector<exitance::Spectrum> reflectance_deviation;  ///< See LoadedScene.
    bool light_groups = false;
    std::vector<std::string> files = {};  ///< Files of the scene. They are read again with states of panes.
    exitance::LoadOptions load = {};      ///< Options with which the files were read.
    std::vector<NamedPane> panes = {};    ///< Panes of the scene with their names.
};

struct SolutionData {
    exitance::Solution solution;
    LightGroups groups;
    mutable std::optional<RadiosityFunction> function;  ///< Made at the first use, under the caller's lock.

    /// The solution with its single mesh, which those with layers lack, and its light. Made like `function`.
    mutable std::unique_ptr<const exitance::Solution> meshed_solution;
    mutable std::optional<RadiosityFunction> meshed_function;

    const RadiosityFunction& light() const {
        if (!function) function.emplace(solution);
        return *function;
    }
    exitance::Result<const exitance::Solution*> meshed() const;
    exitance::Result<const RadiosityFunction*> meshed_light() const;
};

struct StopRequest::State {
    exitance::StopRequest request;
};

inline exitance::Vec3 to_engine(const Vec3& v) {
    return {v.x, v.y, v.z};
}
inline Vec3 to_api(const exitance::Vec3& v) {
    return {v.x, v.y, v.z};
}
inline exitance::Spectrum to_engine(const Spectrum& s) {
    exitance::Spectrum out;
    out.value = s.value;
    return out;
}
inline Spectrum to_api(const exitance::Spectrum& s) {
    Spectrum out;
    out.value = s.value;
    return out;
}
Error to_api(const exitance::Error& error);
Finding to_api(const exitance::Finding& finding);
/// Success, or the engine's error.
Result<void> to_api(const exitance::Result<void>& result);
/// Probes with unit normals. Error (usage): a coordinate is not finite, or a normal has no length.
Result<std::vector<ProbePoint>> to_engine(std::span<const Probe> probes);

/// The error of options out of range; none if all are within.
std::optional<Error> find_misuse(const Scene& scene, const ViewFactorOptions& options);

Error usage(std::string message, std::string where, std::string hint = "");
/// The error of a call that was stopped before it had a result.
Error stopped(std::string_view what);

/// Passes the engine's progress on to the caller's.
class PassedProgress : public exitance::Progress {
  public:
    explicit PassedProgress(api::Progress* to) : to_(to) {}
    void phase(std::string_view name) override {
        if (to_) to_->phase(name);
    }
    void advance(double fraction, std::string_view detail) override {
        if (to_) to_->advance(fraction, detail);
    }
    void note(std::string_view message) override {
        if (to_) to_->note(message);
    }
    void warn(std::string_view message) override {
        if (to_) to_->warn(message);
    }

  private:
    api::Progress* to_;
};

/// Progress and stop request of one call, in the engine's types.
class Run {
  public:
    explicit Run(const Control& control)
        : progress_(control.progress), stop_(control.stop ? control.stop->state().request : own_) {}
    ~Run() { stop_.set_deadline(exitance::StopRequest::Clock::time_point::max()); }
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    exitance::Progress& progress() { return progress_; }
    exitance::StopRequest& stop() { return stop_; }
    /// Requests a stop after some seconds from now; none: no limit.
    void limit_time(const std::optional<double>& seconds);

  private:
    PassedProgress progress_;
    exitance::StopRequest own_;
    exitance::StopRequest& stop_;
};

/// The mutex that calls from several threads take in turn: each call uses all cores, and HDF5 serves one at a time.
std::timed_mutex& turns();

/// Sets the number of threads during its lifetime, which must lie within a turn; 0 leaves it as it is.
class ThreadsOfCall {
  public:
    explicit ThreadsOfCall(int count);
    ~ThreadsOfCall();
    ThreadsOfCall(const ThreadsOfCall&) = delete;
    ThreadsOfCall& operator=(const ThreadsOfCall&) = delete;

  private:
    bool is_set_;
};

/// Calls work(run) when it is this thread's turn. An exception becomes an error. Error (limit): a stop was requested
/// before the turn came.
template <class T, class Work>
Result<T> take_turn(const Control& control, const Work& work) {
    constexpr std::chrono::milliseconds interval{50};  // between checks of the stop request
    Run run(control);
    std::unique_lock turn(turns(), std::defer_lock);
    while (!turn.try_lock_for(interval))
        if (run.stop().requested()) return stopped("waiting for another call");
    try {
        return work(run);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::limit, "there is not enough memory", "", "use a smaller scene or a larger error"};
    } catch (const std::exception& e) {
        return Error{ErrorCode::failure, e.what(), "", "please report this"};
    }
}
template <class T, class Work>
Result<T> take_turn(const Work& work) {
    return take_turn<T>(Control(), [&](Run&) { return work(); });
}

}  // namespace exitance::api

#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exitance/error/hidden_errors.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/error/surface_errors.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Error of one body, accumulated from points on it.
class BodyMeasure {
  public:
    BodyMeasure() = default;
    /// `mean_reflected`: mean reflected radiosity of the body. `light_of_room`: that of its room. Both W/m^2.
    BodyMeasure(double mean_reflected, double light_of_room) : reflected_(mean_reflected), light_(light_of_room) {}

    /// Adds a point: an unbiased estimate of the squared error of radiosity, (W/m^2)^2.
    void add(double squared) { ++points_, sum_ += squared, squares_ += squared * squared; }
    /// Returns a measure of the same body without points.
    BodyMeasure without_points() const { return {reflected_, light_}; }

    std::size_t points() const { return points_; }
    double mean_square() const { return points_ > 0 ? sum_ / static_cast<double>(points_) : 0; }  ///< (W/m^2)^2
    /// Returns the standard error of `mean_square`, from the spread of the points; 0 for fewer than two points.
    double standard_error() const;
    double mean_reflected() const { return reflected_; }  ///< W/m^2
    /// Returns the radiosity to which the body's error is relative, W/m^2: the body's mean reflected radiosity, but at
    /// least a tenth of its room's.
    double reference() const { return std::max(reflected_, min_body_light * light_); }
    /// Returns the RMS error relative to `reference`, but at least the size that the standard error may hide. Empty
    /// below `min_points` points, and if noise hides the error: if the standard error of the mean square exceeds both
    /// half of it and the square of 1.5 times the error `requested`.
    std::optional<double> error(double requested) const;
    /// Returns an optimistic estimate of the error, relative to `reference`: one standard error below the mean square.
    double at_least() const;
    /// Returns a pessimistic estimate of the error, relative to `reference`: one standard error above the mean square.
    double suspected() const;

    static constexpr std::size_t min_points = 8;

  private:
    double reflected_ = 0, light_ = 0;
    std::size_t points_ = 0;
    double sum_ = 0, squares_ = 0;  ///< Sums of the squared errors and of their squares.
};

/// Mean square of the error of a body, (W/m^2)^2, at the points of the certificate that are on it.
struct BodyAtPoints {
    std::size_t points = 0;
    double mean_square = 0, standard_error = 0;
    /// Smallest number of points for an error: on average two in each batch of the standard error.
    static constexpr std::size_t min_points = 64;
};

/// Inputs of the measurement of bodies.
struct BodyCheck {
    const Stage& stage;
    const ElementFunction& indirect;
    const ReflectedLight& b;
    const DirectCheck& check;
    ResidualSampler sampler;
    const SceneBodies& bodies;
    std::span<const Spectrum> late;  ///< The smooth part of the error, by leaf of the coarse mesh.
    std::uint64_t seed;
    const StopRequest* stop = nullptr;  ///< Ends the measurement if a stop is requested; null: never.
    /// Errors by the points of the certificate, for bodies whose own points do not resolve an error; empty: unknown.
    std::span<const BodyAtPoints> at_points = {};
    Progress* progress = nullptr;  ///< Receives the share of the rays that were cast; null: no reports.
    double begins_at = 0;          ///< Fraction of the phase before this measurement, which is the rest of it.
    bool is_stopped() const { return stop && stop->requested(); }
};

/// Result of measure_bodies().
struct MeasuredBodies {
    std::vector<BodyError> errors;   ///< Errors of the bodies, in descending order of area.
    std::vector<PointError> points;  ///< Points of the second stage, relative to the room's light.
    std::size_t rays = 0;            ///< Number of rays cast.
    HiddenErrors hidden = {};        ///< Bodies that the rays did not suffice for.
};

/// Measures the error of every body that reflects. First, each body gets eight points, with enough rays for the
/// standard error of a mean square to be that of 1.5 times the requested error, or as many as half of `max_rays` allow.
/// Three times the requested error, at which users are warned, is then four standard errors above zero. Afterwards,
/// bodies are measured at up to 128 further points, in descending order of their possible error, until the others can
/// neither be the worst nor exceed that limit, or are below the requested error. Each is measured again with more rays
/// until the standard error of its mean square is a quarter of it, or that of 1.5 times the requested error. An error
/// is given where it is at most half. Bodies for which the rays do not suffice, or whose turn does not come before a
/// stop, get the error at the points of the certificate that are on them, if there are at least
/// BodyAtPoints::min_points and noise does not hide the error, as on the walls of a room. Other bodies get no error.
///
/// light_of_room  function that returns the reflected radiosity of a room, W/m^2
/// error          requested relative error
/// max_rays       limit on all rays
/// Returns the errors, the additional points and the number of rays.
MeasuredBodies measure_bodies(const BodyCheck& check, const std::function<double(std::size_t)>& light_of_room,
                              double error, std::size_t max_rays);

}  // namespace exitance

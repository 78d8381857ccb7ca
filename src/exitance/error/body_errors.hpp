#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "exitance/error/residual_samples.hpp"
#include "exitance/error/surface_errors.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// The error of one body, from points on it.
class BodyMeasure {
  public:
    /// One more point: its weight, an unbiased estimate of the squared error of radiosity there, (W/m^2)^2, the
    /// reflected radiosity there and that of the point's room, both W/m^2.
    void add(double weight, double squared, double reflected, double light_of_room);

    std::size_t points() const { return points_; }
    double mean_square() const { return weight_ > 0 ? squared_ / weight_ : 0; }  ///< (W/m^2)^2
    /// Of `mean_square`, from the spread of the points; 0 below two points.
    double standard_error() const;
    double mean_reflected() const { return weight_ > 0 ? reflected_ / weight_ : 0; }  ///< W/m^2
    /// What errors of the body are relative to: its mean reflected radiosity or a tenth of its room's, whichever is
    /// larger, W/m^2.
    double reference() const;
    /// RMS error relative to that, at least what the standard error hides. None below `min_points`, and none where
    /// noise hides the error: where the standard error of the mean square is above half of it and above that of 1.5
    /// times the error `requested`.
    std::optional<double> error(double requested) const;
    /// What the error may be as far as is known, relative to `reference`: one standard error above the mean square.
    double suspected() const;

    static constexpr std::size_t min_points = 8;

  private:
    std::size_t points_ = 0;
    double weight_ = 0, squared_ = 0, reflected_ = 0, light_ = 0;
    double ww_ = 0, wws_ = 0, wwss_ = 0;  ///< Sums of w^2, w^2 s and w^2 s^2.
};

/// What the measurement of bodies reads.
struct BodyCheck {
    const Stage& stage;
    const ElementFunction& indirect;
    const ReflectedLight& b;
    const DirectCheck& check;
    ResidualSampler sampler;
    const SceneBodies& bodies;
    std::span<const Spectrum> late;  ///< The smooth part of the error, by leaf of the coarse mesh.
    std::uint64_t seed;
};

/// Measures the error of every body that reflects. All bodies have eight points each first, with as many rays as make
/// the standard error of a mean square that of 1.5 times the error requested: three times the error requested, which
/// users are warned of, is then told from none by four standard errors. Then the body that may be worst is measured by
/// points of its own until its mean square is known to a quarter, and so on until the worst one is known. Where the
/// rays do not suffice, bodies have no error.
///
/// light_of_room  reflected radiosity of a room, W/m^2     error  requested, relative     max_rays  of all work
/// Returns what was found.
struct MeasuredBodies {
    std::vector<BodyError> errors;   ///< One a body, the largest body first.
    std::vector<PointError> points;  ///< Of the bodies that were measured by points of their own, relative likewise.
    std::size_t rays = 0;            ///< That it took.
};
MeasuredBodies measure_bodies(const BodyCheck& check, const std::function<double(std::size_t)>& light_of_room,
                              double error, std::size_t max_rays);

}  // namespace exitance

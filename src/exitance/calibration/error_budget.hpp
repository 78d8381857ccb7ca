#pragma once

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

/// Largest error of a body, as a multiple of the error requested for the whole. A choice: it decides which errors of
/// small or dark bodies count as wrong.
inline constexpr double max_body_errors = 3;

/// Relative error at which a picture of a scene is just recognizable. Viewers show solutions from this error on, and a
/// result with a larger error is reported as a rough guess. Derived from pictures, by judgement.
inline constexpr double recognizable_error = 0.32;

/// How the requested error R is divided among the parts of a solve. All errors are RMS, relative to the mean reflected
/// light. Independent errors add as squares, so that shares may add up to more than 1. The certificate measures the
/// total; if it exceeds R, another attempt tightens the parts that are too large.
///
/// | part of the error | allowed | used by |
/// |---|---|---|
/// | iterations of the method | `residual()` | `knobs_for_error` |
/// | direct light, projected on the method's elements | `direct_projection()` | `knobs_for_error` |
/// | links, all together | `links()` | `knobs_for_error`, `link_rounds` |
/// | links found by rays, all together | `share_of_links_by_rays` of `links()` | `linked_by_rays` |
/// | local pass: noise of rays | `gather_noise()` | `knobs_for_error` |
/// | local pass: misfit of elements | `gather_misfit()` | `knobs_for_error` |
/// | whole error of one body | `body()` | certificate, warnings, attempts for bodies |
/// | noise, or misfit, of one body | `body_part()` | `knobs_for_error` |
/// | direct light of one element that a body sees | `seen_element_share` of `body_part()` | `Solver::project_direct` |
/// | direct light at a point, if rays evaluate it | `direct_at_point()` | `point_accuracy` |
/// | exported mesh | `exported_mesh()` | `Solver::plain_elements` |
///
/// | of the measurement | allowed | used by |
/// |---|---|---|
/// | exact light at hits that are checked | `checked_hit()` | certificate |
/// | sums over elements at points of the certificate | `certified_sum()` | `Solver::certify_solution` |
/// | noise beside an error that is measured | `independent_share` of it | `interpolant_error` |
///
/// | of another attempt | aim | used by |
/// |---|---|---|
/// | whole error | `next_attempt()` | attempts, discontinuity meshes |
/// | error of the method, if a gather follows | `method_share` of that aim | attempts, forecasts |
/// | error of the local pass | what the method leaves, at least `min_local_share` of that aim | attempts |
/// | each part that is too large | `calibrated::part_aim` of what is allowed | `tightened` |
///
/// The shares that were found by trial are rows of `calibration/numbers.inc`.
class ErrorBudget {
  public:
    explicit constexpr ErrorBudget(double requested) : requested_(requested) {}

    double residual() const { return calibrated::residual_share * requested_; }
    /// `is_delivered`: true if this light is part of the result; otherwise it is only gathered.
    double direct_projection(bool is_delivered) const {
        return (is_delivered ? calibrated::direct_tolerance_fractional : calibrated::direct_tolerance) * requested_;
    }
    double links() const { return calibrated::link_error_share * requested_; }

    /// Features that all points of an element miss matter more when the noise is lower.
    double gather_noise() const {
        return calibrated::gather_noise * requested_ *
               std::pow(std::min(1.0, requested_ / calibrated::finer_gather_below), calibrated::quieter_exponent);
    }
    /// `is_curved`: true for elements of second degree.
    double gather_misfit(bool is_curved) const {
        return (is_curved ? calibrated::curved_tolerance : calibrated::straight_tolerance) * requested_;
    }

    double body() const { return max_body_errors * requested_; }
    double body_part() const { return body_part_share * max_body_errors * requested_; }

    double direct_at_point() const {
        return std::clamp(independent_share * requested_, min_direct_error, max_direct_error);
    }
    double exported_mesh() const { return calibrated::interpolant_error * requested_; }

    /// This error adds a quarter to the squared differences that a check finds if the projection is as wrong as the
    /// solution. If the projection is worse, and checks matter most, it adds less.
    double checked_hit() const {
        return std::clamp(checked_hit_share * requested_, min_direct_error, max_checked_error);
    }
    double certified_sum() const { return calibrated::certified_share * requested_; }

    double next_attempt() const { return calibrated::attempt_aim * requested_; }

    /// Noise of this share of an error makes the error larger by 2%. Derived from adding squares.
    static constexpr double independent_share = 0.2;
    /// The gather smooths the method's light, and much finer meshes of the method soon become expensive.
    static constexpr double method_share = 0.5;
    /// The local pass may have at least this share of the aim of an attempt.
    static constexpr double min_local_share = 0.5;
    static constexpr double share_of_links_by_rays = 0.5;
    /// Derived from four alike, as around the point below the body's middle. Their squared errors, with those of noise
    /// and of misfit, add up to that of the body.
    static constexpr double seen_element_share = 0.7;

  private:
    /// Derived from adding squares: those of noise, of misfit, and twice that of the elements that a body sees.
    static constexpr double body_part_share = 0.5;
    static constexpr double checked_hit_share = 0.5;
    /// Limits, derived from the range of errors that can be requested.
    static constexpr double min_direct_error = 2e-4, max_direct_error = 0.01, max_checked_error = 0.1;

    double requested_;
};

}  // namespace exitance

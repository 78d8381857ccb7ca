#pragma once

#include <cmath>
#include <limits>

#include "exitance/solve/relaxation.hpp"

namespace exitance {

/// Monitors the fluxes of successive reflections, which must decrease: with reflectances below 1 every reflection has
/// less flux than the one before. If they increase, the transport creates light (rows of F that sum to more than 1),
/// and the series diverges.
class GrowthWatch {
  public:
    /// Adds the flux of the next reflection, any unit, not below 0. Returns true if the series grows: the flux rose
    /// `max_rises` times in a row (discretisation may cause one or two), is `max_ratio` times the first, or not finite.
    bool grows(double flux) {
        constexpr int max_rises = 3;
        constexpr double max_ratio = 10;
        rises_ = flux > last_ ? rises_ + 1 : 0;
        if (first_ == 0) first_ = flux;
        last_ = flux;
        return rises_ >= max_rises || !std::isfinite(flux) || flux > max_ratio * first_;
    }

  private:
    double first_ = 0, last_ = std::numeric_limits<double>::max();
    int rises_ = 0;
};

/// Residual, relative to the light that enters, at which a relaxation is stopped as divergent: it is at most 1
/// initially, and over-relaxed sweeps increase it by less.
inline constexpr double diverged_residual = 10;

/// True if a solve ended with a residual of at least 1, no better than zero light. Divergent series end this way.
inline bool has_diverged(const SolveReport& report) {
    return !report.converged && !report.interrupted && !(report.residual < 1);
}

/// Warning of a solution whose solve has diverged.
inline constexpr const char* divergence_warning =
    "the light grows with every reflection instead of settling, so it is wrong: the method's transport creates light "
    "here (use smaller elements or more units, or another method)";

}  // namespace exitance

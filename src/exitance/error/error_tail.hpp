#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// The size of an error at a place, and the share of the area that it stands for.
struct WeightedError {
    double error = 0, weight = 0;
};

/// RMS over the bands.
double rms_over_bands(const Spectrum& error);

/// What errors are below on all but `share` of the area, where only the largest are known one by one:
///
///     sum of w_k over known errors above t  +  w erfc(t / (sqrt(2) rms))  =  share,
///
/// solved for t. The others, of weight w, are known by their root mean square alone, and are spread as Gauss has it,
/// but none of them is above `most`. known  errors, any unit, not negative     rest  that root mean square, and w
/// O(known log known).
double error_below(std::span<const WeightedError> known, WeightedError rest, double share,
                   double most = std::numeric_limits<double>::infinity());

/// Two estimates of the error of B at one place whose noise is independent.
using TwoErrors = std::array<Spectrum, 2>;

/// Estimates errors at some of the places again, with so many times the rays that each took at first.
using ByMoreRays = std::function<void(std::span<const std::size_t> which, unsigned factor, std::span<TwoErrors> error)>;

/// The same where errors are known by few rays: the largest of many are then mostly noise. Those that seem largest are
/// measured again, by many more rays, and what noise is left is taken out in the square; of all others the mean square
/// is known, free of noise: it is what those leave of `mean_square`, of all errors; and none seemed larger than the
/// least of those that are measured again. Weights sum to about 1. rays     of each place so far: a quarter of all of
/// them is spent again, or twice those of the places measured again
double error_below(std::span<const WeightedError> noisy, std::span<const unsigned> rays, double mean_square,
                   double share, const ByMoreRays& measure);

}  // namespace exitance

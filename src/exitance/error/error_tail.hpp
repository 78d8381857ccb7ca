#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>

#include "exitance/base/spectrum.hpp"

namespace exitance {

/// The size of an error at a place, and the share of the area that the place represents.
struct WeightedError {
    double error = 0, weight = 0;
};

/// Returns the RMS over the bands.
double rms_over_bands(const Spectrum& error);

/// Returns the error that is exceeded on only `share` of the area, if just the largest errors are known individually:
///
///     sum of w_k over known errors above t  +  w erfc(t / (sqrt(2) rms))  =  share,
///
/// solved for t. The remaining errors, of total weight w, are assumed to be normally distributed with a known root mean
/// square, but not above `most`.
///
/// known  errors in any unit, not negative
/// rest   root mean square and total weight w of the remaining errors
/// O(known log known).
double error_below(std::span<const WeightedError> known, WeightedError rest, double share,
                   double most = std::numeric_limits<double>::infinity());

/// Two estimates of the error of B at one place, with independent noise.
using TwoErrors = std::array<Spectrum, 2>;

/// Estimates the errors at some of the places again, with `factor` times as many rays as each had at first.
using ByMoreRays = std::function<void(std::span<const std::size_t> which, unsigned factor, std::span<TwoErrors> error)>;

/// Like `error_below` above, for errors that were estimated with few rays, so that the largest of them are mostly
/// noise. The places with the largest apparent errors are measured again with many more rays, and the remaining noise
/// is subtracted from their squares. The mean square of all other errors is what these leave of `mean_square`, the
/// noise-free mean square of all errors. The others are assumed not to exceed the smallest apparent error that was
/// measured again. Weights sum to about 1. The result is 0 if noise hides the largest errors.
///
/// rays  rays of each place so far. A quarter of their sum is cast again, but at least twice the rays of the repeated
/// places.
double error_below(std::span<const WeightedError> noisy, std::span<const unsigned> rays, double mean_square,
                   double share, const ByMoreRays& measure);

}  // namespace exitance

#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// Solves b = rho (D + F b) on the sources of stored transport, W/m^2; or sums `bounces` reflections, at least one, if
/// that is not negative. `direct`: D, W/m^2; `reflectance`: rho.
std::vector<Spectrum> reflected_light(const KeptOperator& F, std::span<const Spectrum> reflectance,
                                      std::span<const double> area, std::span<const Spectrum> direct, int bounces,
                                      const StopRequest* stop = nullptr);

/// Means over the sources of a function on the interpolant's elements, W/m^2.
std::vector<Spectrum> source_means(const TransportLayout& layout, const CornerValues& interpolant);

/// RMS of rho E over surfaces and bands for `indirect`, W/m^2.
double rms_reflected(const Solution& solution);
/// RMS of rho (E - E') relative to that of rho E, where E is `indirect` and E' has `values` instead.
double relative_difference(const Solution& solution, const CornerValues& values);

}  // namespace exitance

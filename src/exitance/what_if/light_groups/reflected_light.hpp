#pragma once

#include "exitance/base/progress.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {

/// b = rho (D + F b) on the sources of kept transport, W/m^2; where `bounces` is not negative, what is reflected so
/// often, at least once. `direct`: D, `reflectance`: rho.
std::vector<Spectrum> reflected_light(const KeptOperator& F, std::span<const Spectrum> reflectance,
                                      std::span<const double> area, std::span<const Spectrum> direct, int bounces,
                                      const StopRequest* stop = nullptr);

/// Means over the sources of a function on the interpolant's elements, W/m^2.
std::vector<Spectrum> source_means(const TransportLayout& layout, const CornerValues& interpolant);

/// RMS of rho E over the surfaces and bands, E that of `indirect`, W/m^2.
double rms_reflected(const Solution& solution);
/// RMS of rho (E - E') over that of rho E, E that of `indirect`, E' that of these values in its place.
double relative_difference(const Solution& solution, const CornerValues& values);

}  // namespace exitance

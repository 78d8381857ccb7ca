#pragma once

#include <span>
#include <vector>

#include "exitance/error/direct_check.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

/// Difference between the coarse response to residuals and the response found by paths.
struct LateMisfit {
    double mean_square = 0;     ///< Unbiased estimate over all surfaces, mean over bands, (W/m^2)^2.
    double standard_error = 0;  ///< Standard error of `mean_square`.
    std::size_t rays = 0;       ///< Number of rays cast.
    bool is_significant() const { return mean_square > 2 * standard_error; }
};

/// Estimates by paths the part rho H e of the error e = r + rho H e, which arrives by way of other surfaces. A path
/// starts with one ray of a gather and ends with probability 1 - rho at each vertex. At each vertex y it samples the
/// residual
///
///     E_ind(z), read at the hit z of the next ray, with the direct light at z checked, minus E_ind(y).
///
/// The delivered light is the control variate of the light that the path would find. No fitted or averaged residuals
/// are used.
class LatePaths {
  public:
    /// `b` and `indirect` are the delivered function. `holds_direct`: `indirect` includes the emitters' light. All
    /// arguments must outlive the object.
    LatePaths(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b, const DirectCheck& check,
              bool holds_direct);

    /// Returns one sample of (H e)(x), W/m^2, and adds the rays cast to `rays`. `a`, `b`: random numbers in [0, 1) for
    /// the direction of the first ray.
    Spectrum sample(const SurfacePoint& x, double a, double b, RandomStream& random, std::size_t& rays) const;

    /// Compares `late` (one entry per leaf of the coarse mesh) with two independent sets of paths at some of the
    /// samples. Casts about `max_rays` rays. In one of forty cases noise alone is reported as a misfit. A significant
    /// result is therefore dropped and measured again, at other places and with other and more paths.
    LateMisfit misfit(std::span<const ResidualSample> samples, std::span<const Spectrum> late, std::uint64_t seed,
                      std::size_t max_rays) const;

  private:
    /// Measures the misfit with two sets of `paths` paths at each place.
    LateMisfit measure(std::span<const ResidualSample> samples, std::span<const Spectrum> late, std::uint64_t seed,
                       std::uint32_t paths) const;
    Spectrum read(const ReflectedLight& light, const SurfacePoint& y) const;

    const Stage& stage_;
    const ElementFunction& indirect_;
    const ReflectedLight& b_;
    const DirectCheck& check_;
    bool holds_direct_;
    ElementLocator locator_;
};

}  // namespace exitance

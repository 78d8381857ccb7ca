#pragma once

#include <span>
#include <vector>

#include "exitance/error/direct_check.hpp"
#include "exitance/error/residual_samples.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

/// How far a response to residuals is from the one that paths find.
struct LateMisfit {
    double mean_square = 0;     ///< An unbiased estimate over all surfaces, mean over bands, (W/m^2)^2,
    double standard_error = 0;  ///< and its standard error.
    std::size_t rays = 0;       ///< That it took.
};

/// The part of the error e = r + rho H e that comes by way of other surfaces, rho H e, by paths. A path starts with one
/// ray of a gather and ends with probability 1 - rho. At each vertex y it finds the residual there,
///
///     E_ind(z) read where the next ray arrives, with the direct light at z checked, less E_ind(y):
///
/// the delivered light is the control variate of the light that the path would find. Nothing that was fitted or
/// averaged is read.
class LatePaths {
  public:
    /// `b` reads the delivered function, and so does `indirect`. All must outlive it. `holds_direct`: `indirect` holds
    /// the light of emitters, too.
    LatePaths(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b, const DirectCheck& check,
              bool holds_direct);

    /// One sample of (H e)(x), W/m^2, and the rays that it took.
    Spectrum sample(const PathTracer::Vertex& x, double a, double b, RandomStream& random, std::size_t& rays) const;

    /// Compares `late` (by leaf of the coarse mesh) with two independent sets of paths at some of the samples, by about
    /// `max_rays` rays.
    LateMisfit misfit(std::span<const ResidualSample> samples, std::span<const Spectrum> late, std::uint64_t seed,
                      std::size_t max_rays) const;

  private:
    Spectrum read(const ReflectedLight& light, const PathTracer::Vertex& y) const;

    const Stage& stage_;
    const ElementFunction& indirect_;
    const ReflectedLight& b_;
    const DirectCheck& check_;
    bool holds_direct_;
    ElementLocator locator_;
};

}  // namespace exitance

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

/// The part of one path in the mean of 2 (r + late) m over all surfaces. m is the light that paths find, less the
/// coarse response.
struct CorrelationTerm {
    std::uint32_t sample = 0;  ///< Number of the sample at which the path ends.
    double value = 0;          ///< Term of the weighted sum over the samples, mean over bands, (W/m^2)^2.
};

/// Estimates by paths the part rho H e of the error e = r + rho H e, which arrives by way of other surfaces. A path
/// starts with one ray and ends with probability 1 - rho at each vertex. At each vertex y, a gather of a few rays
/// measures the residual
///
///     E(y), the mean of the delivered light at the hits, with the direct light there checked, minus E_ind(y).
///
/// The delivered light is the control variate of the light that the path would find. No fitted or averaged residuals
/// are used.
class LatePaths {
  public:
    /// `b` and `indirect` are the delivered function. `holds_direct`: `indirect` includes the emitters' light. `plans`:
    /// how the hits of rays from each room are checked. `stop`: ends the measurements, which then find nothing; null:
    /// never. All arguments must outlive the object.
    LatePaths(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b, const DirectCheck& check,
              std::span<const CheckPlan> plans, bool holds_direct, const StopRequest* stop = nullptr);

    struct Workspace {
        GatherWorkspace rays;
        DirectCheck::Workspace check;
    };

    /// Returns one sample of (H e)(x), W/m^2, and adds the rays cast to `rays`. `a`, `b`: random numbers in [0, 1) for
    /// the direction of the first ray.
    Spectrum sample(const SurfacePoint& x, double a, double b, RandomStream& random, Workspace& w,
                    std::size_t& rays) const;

    /// Compares `late` (one entry per leaf of the coarse mesh) with two independent sets of paths at some of the
    /// samples. Casts about `max_rays` rays. In one of forty cases noise alone is reported as a misfit. A significant
    /// result is therefore dropped and measured again, at other places and with other and more paths.
    LateMisfit misfit(std::span<const ResidualSample> samples, std::span<const Spectrum> late, std::uint64_t seed,
                      std::size_t max_rays) const;

    /// Measures the product of the error e at a place with the light m that the coarse response lacks there. Between
    /// slats both have the same sign, since light is reflected back to where it came from. Few paths resolve the
    /// product, since it is linear in their noise, while the square that `misfit` measures is not. Places are chosen
    /// with a probability proportional to their error, the light delivered there, and `weight_of_place`, which has one
    /// entry per sample. The sum of the terms is unbiased for places that receive light. Casts about `max_rays` rays,
    /// which are added to `rays`.
    std::vector<CorrelationTerm> correlation(std::span<const ResidualSample> samples,
                                             std::span<const double> weight_of_place, std::span<const Spectrum> late,
                                             std::uint64_t seed, std::size_t max_rays, std::size_t& rays) const;

  private:
    Spectrum residual(const SurfacePoint& y, RandomStream& random, Workspace& w, std::size_t& rays) const;
    double rays_per_path() const;
    bool is_stopped() const { return stop_ && stop_->requested(); }
    /// Measures the misfit with two sets of `paths` paths at each place.
    LateMisfit measure(std::span<const ResidualSample> samples, std::span<const Spectrum> late, std::uint64_t seed,
                       std::uint32_t paths) const;

    const Stage& stage_;
    const ElementFunction& indirect_;
    const ReflectedLight& b_;
    const DirectCheck& check_;
    std::span<const CheckPlan> plans_;
    bool holds_direct_;
    const StopRequest* stop_;
    ElementLocator locator_;
};

}  // namespace exitance

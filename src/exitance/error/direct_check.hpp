#pragma once

#include <functional>

#include "exitance/direct/clustered_light.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/gather/path_tracer.hpp"

namespace exitance {

/// The direct light that a function reads at ray hits, to be checked against the true direct light.
struct ProjectedDirect {
    const ReflectedLight* irradiance = nullptr;  ///< E_proj at the hits, W/m^2; null where no projection is read.
    Spectrum weight{1.0};                        ///< w, the share of E_proj in the function.
    /// RMS of rho (E_dir - E_proj) on the element at a hit, as the projection measured it, W/m^2; empty: not known.
    std::function<double(const HitPoint&)> misfit = {};
};

/// How the hits of a gather are checked.
struct CheckPlan {
    bool is_exact = false;  ///< E_dir exactly as points of a solution have it, or by one step of a path.
    /// A hit is checked with probability `share` + `per_misfit` times the misfit there (m^2/W), at most 1; `share` > 0.
    double share = 1, per_misfit = 0;
    /// Forecast variances of one ray's terms in rho E, mean over bands, (W/m^2)^2: of the check, and of the gather.
    double variance = 0, gather_variance = 0;
    double work = 0;  ///< Forecast work of the checks by one ray of the gather, in rays.
};

/// Adds what a gather misses because it reads projected in place of true direct light:
///
///     sum over the hits y that are checked of  rho w (E_dir(y) - E_proj(y)) / (q(y) n),
///
/// n the number of rays, q(y) the probability that y is checked. The projection serves as a control variate, so that
/// the sum of both is unbiased however wrong the projection is. E_dir is one step of a path (1 to 3 rays), at any hit
/// alike; or it is what points of a solution have (exact, or to a tenth of its error by clusters), in proportion to the
/// misfit that the projection measured itself.
class DirectCheck {
  public:
    /// `accuracy` is that of exact light where emitters are many. All but it must outlive the check.
    DirectCheck(const Stage& stage, const PathTracer& paths, const ProjectedDirect& projected,
                const LightAccuracy& accuracy);

    struct Workspace {
        ClusteredLight::Workspace clustered;
        std::vector<HitPoint> hits;
        std::vector<double> counts;  ///< Of each hit, by the probability of its check.
        std::vector<Spectrum> projected;
    };

    bool has_projection() const { return projected_.irradiance != nullptr; }

    /// The sum above over the hits that `gather` holds, W/m^2. `key` names the random numbers.
    Spectrum missing(const CheckPlan& plan, const GatherWorkspace& gather, std::uint64_t key, Workspace& room) const;

    /// w (E_dir - E_proj) at one hit, W/m^2: one unbiased sample of E_dir, or exact.
    Spectrum difference(bool is_exact, const HitPoint& hit, const Spectrum& projected, RandomStream& random,
                        ClusteredLight::Workspace& room) const;

    double probability(const CheckPlan& plan, const HitPoint& hit) const;
    double misfit(const HitPoint& hit) const { return projected_.misfit ? projected_.misfit(hit) : 0; }
    /// Work of exact light at a point, in rays: microseconds by those of a ray, as `DirectLight` has them for diffuse
    /// emitters; a form factor weighted by radiance is a quadrature, some twenty times as expensive.
    double exact_work() const;

    const PathTracer& paths() const { return *paths_; }
    const ProjectedDirect& projected() const { return projected_; }

  private:
    const Stage* stage_;
    const PathTracer* paths_;
    ProjectedDirect projected_;
    LightAccuracy accuracy_;
};

/// A place that a pilot gathers at.
struct PilotPlace {
    SurfacePoint at;
    double weight;  ///< Its share in the mean over all places.
};

/// What the noise of checks is to be small beside.
struct OtherNoise {
    double tolerated = 0;         ///< Variance per ray that does no harm, (W/m^2)^2,
    bool gather_is_noisy = true;  ///< and that of the gather itself, where it has noise.
};

/// Chooses how hits are checked, by a pilot of a few rays from each place that is not used again. The probability of a
/// check is the one by which the product of variance and work is least: with work k and variance V of a check, by those
/// of a gather's ray, sqrt(V / k); of both ways the one with less k V. It is never 0. O(places).
CheckPlan plan_check(const DirectCheck& check, const Stage& stage, const ReflectedLight& b,
                     std::span<const PilotPlace> places, std::uint64_t seed, const OtherNoise& other);

}  // namespace exitance

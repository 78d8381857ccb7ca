#pragma once

#include <algorithm>
#include <functional>

#include "exitance/direct/place_light.hpp"
#include "exitance/gather/gather.hpp"
#include "exitance/gather/path_tracer.hpp"

namespace exitance {

/// The projected direct light that a function reads at ray hits, to be checked against the true direct light.
struct ProjectedDirect {
    const ReflectedLight* irradiance = nullptr;  ///< E_proj at the hits, W/m^2; null: no projection is read.
    Spectrum weight{1.0};                        ///< w, the share of E_proj in the function.
    /// RMS of rho (E_dir - E_proj) on the element at a hit, as measured by the projection, W/m^2; empty: unknown.
    std::function<double(const RayEnd&)> misfit = {};
};

/// Parameters for checking the hits of a gather.
struct CheckPlan {
    bool is_exact = false;  ///< True: E_dir is evaluated as at points of a solution; false: by one step of a path.
    /// A hit is checked with probability `share` + `per_misfit` times the misfit there (m^2/W), at most 1; `share` > 0.
    double share = 1, per_misfit = 0;
    /// Absolute error that E_dir may have besides the relative one if it is evaluated as at points, W/m^2.
    double absolute_error = 0;
    /// Predicted variances of one ray's terms in rho E, mean over bands, (W/m^2)^2: of the check, and of the gather.
    double variance = 0, gather_variance = 0;
    double work = 0;  ///< Predicted work of the checks per ray of the gather, in rays.
    /// Returns the probability that a hit with this misfit is checked.
    double probability(double misfit) const { return std::min(1.0, share + per_misfit * misfit); }
};

/// Corrects a gather for reading projected instead of true direct light. The correction is
///
///     sum over the checked hits y of  rho w (E_dir(y) - E_proj(y)) / (q(y) n),
///
/// with n the number of rays and q(y) the probability that y is checked. The projection serves as a control variate:
/// the corrected gather is unbiased for any projection. E_dir is estimated in one of two ways: by one step of a path (1
/// to 3 rays), with equal probability at all hits; or as at points of a solution (exactly, or by rays to half of
/// the solution's error, in dim places to a tenth of the gather's noise), with a probability that grows with the misfit
/// measured by the projection.
class DirectCheck {
  public:
    /// `accuracy`: accuracy of exact light in scenes with many emitters. All other arguments must outlive the check.
    DirectCheck(const Stage& stage, const PathTracer& paths, const ProjectedDirect& projected,
                const LightAccuracy& accuracy);

    struct Workspace {
        PlaceLight::Workspace clustered;  ///< For direct light at hits, exact or by rays.
        std::vector<RayEnd> hits;
        std::vector<Spectrum> counts;  ///< Rays per hit, times their colours, divided by the probability of its check.
        std::vector<Spectrum> projected;
    };

    bool has_projection() const { return projected_.irradiance != nullptr; }

    /// Returns the correction above for the hits in `gather`, W/m^2. `key` selects the random numbers.
    Spectrum missing(const CheckPlan& plan, const GatherWorkspace& gather, std::uint64_t key, Workspace& room) const;

    /// w (E_dir - E_proj) at a hit, W/m^2, and the work of finding it, in rays.
    struct Difference {
        Spectrum light;
        double work = 0;
    };
    /// Returns the difference, with E_dir evaluated as a solution does at points. The work of closed forms grows with
    /// the blockers cut from the emitters; directed radiance makes them quadratures, some twenty times as expensive.
    /// `absolute_error`: see CheckPlan.
    Difference exact_difference(const RayEnd& hit, const Spectrum& projected, double absolute_error,
                                PlaceLight::Workspace& room) const;
    /// Returns an unbiased sample of the difference, by one step of a path.
    Spectrum sampled_difference(const RayEnd& hit, const Spectrum& projected, RandomStream& random) const;

    double probability(const CheckPlan& plan, const RayEnd& hit) const;
    double misfit(const RayEnd& hit) const { return projected_.misfit ? projected_.misfit(hit) : 0; }

    const PathTracer& paths() const { return *paths_; }
    const ProjectedDirect& projected() const { return projected_; }

  private:
    const Stage* stage_;
    const PathTracer* paths_;
    ProjectedDirect projected_;
    LightAccuracy accuracy_;
    double closed_form_work_ = 0;  ///< Least work of exact light at a point, in rays.
};

/// A place of the pilot, which predicts variances.
struct PilotPlace {
    RayEnd at;
    double weight;    ///< Weight in the mean over the pilot's places; only ratios count.
    double rays = 1;  ///< Number of rays that places like this one receive; only ratios count.
};

/// Other noise, to which that of the checks is compared.
struct OtherNoise {
    double tolerated = 0;  ///< Acceptable variance per ray, (W/m^2)^2.
    /// Smallest share of hits to check. Some errors are missed by the projection's own estimate and by all pilot rays;
    /// only such checks find them.
    double min_share = 1.0 / 256;
    bool gather_is_noisy = true;  ///< True if the gather itself is noisy; its variance is then included.
};

/// Chooses the parameters of the checks from a pilot of a few rays at each place, which are not used otherwise. The
/// probability of a check minimizes the product of variance and work: it is sqrt(V / k) for checks with work k and
/// variance V, both relative to those of one ray of the gather. Of the two ways to evaluate E_dir, the one with the
/// smaller product is used; exact light also at up to twice the variance and work. If that takes more than the gather,
/// exact light may be less accurate in dim places. The probability is never 0. O(places).
CheckPlan plan_check(const DirectCheck& check, const Stage& stage, const ReflectedLight& b,
                     std::span<const PilotPlace> places, std::uint64_t seed, const OtherNoise& other);

}  // namespace exitance

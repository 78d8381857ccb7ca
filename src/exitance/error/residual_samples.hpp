#pragma once

#include "exitance/base/loop_progress.hpp"
#include "exitance/error/certificate_places.hpp"
#include "exitance/error/direct_check.hpp"
#include "exitance/mesh/numbered_leaves.hpp"

namespace exitance {

/// A point at which the certificate measures the residual, with two independent estimates of it.
struct ResidualSample {
    ElementTree::Place place;  ///< Place in the delivered function.
    RegionId region;
    SurfaceId surface;
    std::uint32_t room = 0;
    /// True if another surface covers the point or a body contains it (`is_in_open`). It is dark there and cannot be
    /// seen, and the residual is 0 for any delivered light.
    bool is_covered = false;
    double weight = 0;
    Spectrum r1, r2;          ///< Two estimates of the residual, W/m^2.
    double squared = 0;       ///< Estimated square of the error, mean over bands, (W/m^2)^2.
    Spectrum local1, local2;  ///< The parts of r1 and r2 that the local pass causes, if `is_divided`.
    bool is_divided = false;
    Spectrum delivered;      ///< Delivered irradiance without direct light, W/m^2.
    double reflected = 0;    ///< Reflected radiosity with the projected direct light, mean over bands, W/m^2.
    std::uint32_t leaf = 0;  ///< Leaf number in the coarse mesh.
    std::uint32_t rays = 0;
    bool is_measured = false;  ///< False if a stop was requested before.
};

/// Returns the number of rays of each of a point's two gathers that resolves a relative error as the mean over this
/// many points. A gather of n rays has a variance proportional to 1 / n, and so has the product of two. The noise of
/// the mean product is therefore a given share of the squared error for
///
///     n = `certificate_noise` / (error^2 sqrt(points)).
double rays_to_resolve(double error, std::size_t points);

/// Rounds a number of rays up to a power of two, within the limits for a certificate.
unsigned certificate_rays(double wanted);

/// Measures residuals of a delivered function at points; see `Certifier`.
class ResidualSampler {
  public:
    struct Workspace {
        GatherWorkspace rays;
        ElementGather::Workspace sums;
        PlaceLight::Workspace clustered;  ///< For direct light at points, exact or by rays.
        DirectCheck::Workspace check;
    };

    /// The light that is delivered, on elements and as rays find it at their hits.
    struct Delivered {
        const ElementFunction& indirect;
        const ReflectedLight& b;
    };

    /// `constant`: ratio of the error bound to the residual. `coarse`: leaves of the coarse mesh. All that arguments
    /// refer to must outlive the object.
    ResidualSampler(const Stage& stage, const Delivered& light, const DirectCheck& check,
                    const CertificateOptions& options, double constant, const NumberedLeaves& coarse);

    /// Measures the residual twice at each place; `samples` has one entry per place. `plans` determines how the direct
    /// light at hits of rays from each room is checked. Returns false if a stop was requested before all places were
    /// measured. `part` counts the places. O(places x rays), parallel.
    bool measure(std::span<const WeightedSample> places, std::span<const CheckPlan> plans, std::uint64_t seed,
                 std::span<ResidualSample> samples, const StopRequest* stop = nullptr, PhasePart part = {}) const;

    /// Sets the position of a sample and the light delivered there.
    void locate(const WeightedSample& place, ResidualSample& sample, Workspace& w) const;

    /// Returns the number of rays of each of the two gathers at a leaf of the delivered function.
    unsigned rays_at(ElementId leaf) const;

    /// Returns another estimate of the residual at a sample's point, from this many rays.
    Spectrum by_rays(const ResidualSample& sample, const CheckPlan& plan, unsigned rays, std::uint64_t key,
                     Workspace& workspace) const;

    /// Rays of each of a sample's two estimates that check projected direct light if reflected light is summed.
    static constexpr unsigned rays_beside_sums = 32;

  private:
    void sum_elements(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                      Workspace& w) const;
    void cast_rays(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                   Workspace& w) const;
    Point point(const ResidualSample& sample) const;

    const Stage& stage_;
    const Delivered light_;
    const DirectCheck& check_;
    const CertificateOptions& options_;
    /// Factor on the number of rays. It is above 1 if light is reflected so often that a small mean residual causes a
    /// large error.
    double ray_factor_;
    const NumberedLeaves coarse_;
};

}  // namespace exitance

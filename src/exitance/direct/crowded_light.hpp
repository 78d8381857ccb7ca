#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Light of sources behind many blockers, such as slats of a blind or leaves, estimated by rays. The cost of an exact
/// visible part grows with the number of blockers, while a ray is cheap. For light that is only gathered from, noise up
/// to an allowed variance is acceptable:
///
///     E = M F sum over rays of  K_i V_i / sum over rays of  K_i,    K = cos cos / (pi r^2) over their density,
///
/// from a point to points of the source (SeenPolygon, weighted by its relative radiance); F is the unoccluded form
/// factor. The random points of a receiver point depend only on its coordinates: repeated calls give the same light,
/// and errors of neighbouring points are independent. A source is classified as crowded without finding all of its
/// blockers: the search stops when exact visibility is certainly more expensive than rays.
class CrowdedLight {
  public:
    using SourceName = DirectLight::SourceName;

    /// `direct` and `tracer` must outlive it.
    CrowdedLight(const DirectLight& direct, const RayTracer& tracer) : direct_(&direct), tracer_(&tracer) {}

    /// Sources of a receiver whose light is estimated by rays.
    struct Crowd {
        struct Source {
            ReceiverLight::Source source;
            double factor = 0;  ///< F at the receiver's centre; constant over the receiver for the open sky.
        };
        std::vector<Source> sources;
        /// Maximum number of rays per point and source: a power of two, sufficient for a half-hidden source.
        unsigned rays = 0;
        double allowed = 0;  ///< Allowed variance of a value, (W/m^2)^2.
        bool empty() const { return sources.empty(); }
    };
    struct Estimate {
        Spectrum irradiance;  ///< W/m^2
        Spectrum parallel;    ///< The part of it that comes from the sky.
        /// Variance of the mean over bands, (W/m^2)^2, from the spread of four quarters of the rays.
        double variance = 0;
    };
    static constexpr unsigned least_rays = 4, most_rays = 4096;

    /// Like `DirectLight::prepare`, from a convex polygon of region `own`, but separates the sources for which rays are
    /// cheaper. Returns these; `light` has only the others.
    /// allowed  allowed variance of a value, (W/m^2)^2; 0: all sources are exact
    /// named    the sources to consider; null: all, and beams
    Crowd prepare(std::span<const Point> receiver, const Normal& n, RegionId own, double allowed, ReceiverLight& light,
                  DirectLight::Workspace& scratch, const std::vector<SourceName>* named = nullptr) const;

    /// Estimates the light of these sources at points of the receiver for which `light` was prepared. Starts with a
    /// quarter of `crowd.rays` and doubles until the variance, in the mean over the points, is the allowed one.
    std::vector<Estimate> at(const ReceiverLight& light, const Crowd& crowd, std::span<const Point> places,
                             DirectLight::Workspace& scratch) const;

    /// Returns the number of rays from a point to a source of unoccluded irradiance E, W/m^2, for the variance
    /// `allowed` even if it is half hidden: a power of two.
    static unsigned rays_for(double E, double allowed);

  private:
    struct Sums;
    Crowd take_crowded(ReceiverLight& light, const Point& middle, double allowed,
                       DirectLight::Workspace& scratch) const;
    bool may_be_crowded(const SourceName& source) const;
    double power_at(const Receiver& at, RegionId own, const std::vector<SourceName>* named,
                    DirectLight::Workspace& scratch) const;
    double unblocked(const Receiver& at, const SourceName& source, DirectLight::Workspace& scratch) const;
    void cast(const ReceiverLight& light, const ReceiverLight::Source& source, std::span<const Point> places,
              unsigned first, unsigned last, std::span<Sums> sums) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
};

}  // namespace exitance

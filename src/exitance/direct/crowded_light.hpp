#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Light of sources before which many things stand: slats of a blind, leaves. An exact visible part costs by the
/// blocker, a ray next to nothing, and where light is only gathered from, exactness is worth no more than the noise
/// that may stay:
///
///     E = M F sum over rays of  K_i V_i / sum over rays of  K_i,    K = cos cos / (pi r^2) over their density,
///
/// from a place to places of the source (SeenPolygon, by its relative radiance), F with nothing in between. A place's
/// net on the source is named by its coordinates: it has the same light, whoever asks, and places side by side err
/// independently. Whether a source is crowded is decided without finding all that stands before it: the search ends
/// where exactness is seen to cost more than rays.
class CrowdedLight {
  public:
    using SourceName = DirectLight::SourceName;

    /// Both must outlive it.
    CrowdedLight(const DirectLight& direct, const RayTracer& tracer) : direct_(&direct), tracer_(&tracer) {}

    /// What is left to rays of the light of a receiver.
    struct Crowd {
        struct Source {
            ReceiverLight::Source source;
            double factor = 0;  ///< F at the middle of the receiver; of the sky the same everywhere on it.
        };
        std::vector<Source> sources;
        unsigned rays = 0;   ///< Of a place and source, at most: a power of two that a half-hidden source needs.
        double allowed = 0;  ///< Variance of a value, (W/m^2)^2.
        bool empty() const { return sources.empty(); }
    };
    struct Estimate {
        Spectrum irradiance;  ///< W/m^2
        Spectrum parallel;    ///< What of it comes from the sky.
        double variance = 0;  ///< Of its mean over bands, (W/m^2)^2, from the spread of four quarters of the rays.
    };
    static constexpr unsigned least_rays = 4, most_rays = 4096;

    /// As `DirectLight::prepare`, from a convex polygon of region `own`, but for the sources that rays find for less
    /// where a value may have the variance `allowed`, (W/m^2)^2; 0: all are exact. Those are returned, and are not in
    /// `light`. `named`: the sources to look at; none: all, and beams.
    Crowd prepare(std::span<const Point> receiver, const Normal& n, RegionId own, double allowed, ReceiverLight& light,
                  DirectLight::Workspace& scratch, const std::vector<SourceName>* named = nullptr) const;

    /// What these bring to places of the receiver that `light` was prepared for. Rays are doubled, from a quarter of
    /// `crowd.rays` on, until the variance is what is allowed, in the mean over the places.
    std::vector<Estimate> at(const ReceiverLight& light, const Crowd& crowd, std::span<const Point> places,
                             DirectLight::Workspace& scratch) const;

    /// Rays of a place to a source that brings E, W/m^2, for the variance `allowed` wherever it is half hidden: a power
    /// of two.
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

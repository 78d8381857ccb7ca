#pragma once

#include <vector>

#include "exitance/direct/direct_light.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Light of sources before which many things stand: slats of a blind, leaves. An exact visible part costs by the
/// blocker, a ray next to nothing, and where light is only gathered from, exactness is worth no more than the noise
/// that may stay:
///
///     E = M F sum over rays of  K_i V_i / sum over rays of  K_i,    K = cos cos / (pi r^2),
///
/// from one place to places of the source (times its relative radiance), F as if nothing stood in between. The same
/// place has the same light, whoever asks.
class CrowdedLight {
  public:
    /// Both must outlive it.
    CrowdedLight(const DirectLight& direct, const RayTracer& tracer) : direct_(&direct), tracer_(&tracer) {}

    struct Estimate {
        Spectrum irradiance;  ///< W/m^2
        double variance = 0;  ///< Of its mean over bands, (W/m^2)^2, as if rays were by chance.
    };
    static constexpr unsigned most_rays = 256;
    struct Source {
        ReceiverLight::Source source;
        double factor = 0;  ///< F at the middle of the receiver; of the sky the same everywhere on it.
    };

    /// Takes out of `light` the sources that rays find for less, where a value at `middle` may have the variance
    /// `allowed`, (W/m^2)^2. `rays`: how many a place and source needs then.
    std::vector<Source> take_crowded(ReceiverLight& light, const Point& middle, double allowed,
                                     DirectLight::Workspace& scratch, unsigned& rays) const;

    /// What these bring to a place of the receiver that `light` was made for; `rays`: at most `most_rays`, each. What
    /// comes from the sky is added to `parallel`, if given.
    Estimate at(const ReceiverLight& light, std::span<const Source> sources, const Point& x, unsigned rays,
                DirectLight::Workspace& scratch, Spectrum* parallel = nullptr) const;

  private:
    double unblocked(const Receiver& at, const ReceiverLight::Source& source, DirectLight::Workspace& scratch) const;

    const DirectLight* direct_;
    const RayTracer* tracer_;
};

}  // namespace exitance

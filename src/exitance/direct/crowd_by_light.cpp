#include "exitance/direct/crowd_by_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace exitance {

std::vector<CrowdedLight::Estimate> estimates_by_light(const CrowdedLight& by_rays, const ReceiverLight& light,
                                                       const CrowdedLight::Crowd& crowd, std::span<const Point> places,
                                                       double kept, double mean_light,
                                                       DirectLight::Workspace& scratch) {
    CrowdedLight::Crowd first = crowd, rest = crowd;
    first.rays = CrowdedLight::least_rays, first.allowed = HUGE_VAL;
    const double count = static_cast<double>(places.size());
    double E = 0, variance = 0;  // means over the points
    for (const CrowdedLight::Estimate& at : by_rays.at(light, first, places, scratch))
        E += mean(at.irradiance) / count, variance += at.variance / count;
    rest.allowed = 0.5 * crowd.allowed * (1 + E / mean_light) / kept;
    // `at` starts with a quarter of the rays and doubles them. There is a minimum, so that points are not considered
    // noise-free just because their few rays to a half-hidden source agree by chance.
    constexpr unsigned least = 16, doubling_factor = 4;
    const double wanted = std::clamp(first.rays * variance / rest.allowed, 1.0 * least, 1.0 * CrowdedLight::most_rays);
    rest.rays = std::clamp(doubling_factor * std::bit_floor(static_cast<unsigned>(wanted)), doubling_factor * least,
                           std::max(crowd.rays, doubling_factor * least));
    return by_rays.at(light, rest, places, scratch);
}

}  // namespace exitance

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
    double E = 0, variance = 0;  // means over the places
    for (const CrowdedLight::Estimate& at : by_rays.at(light, first, places, scratch))
        E += mean(at.irradiance) / count, variance += at.variance / count;
    rest.allowed = 0.5 * crowd.allowed * (1 + E / mean_light) / kept;
    // `at` begins with a quarter of the rays and doubles them. That are so many at least that places which all see the
    // same of a half-hidden source are no chance.
    constexpr unsigned least = 16, doubled_twice = 4;
    const double wanted = std::clamp(first.rays * variance / rest.allowed, 1.0 * least, 1.0 * CrowdedLight::most_rays);
    rest.rays = std::clamp(doubled_twice * std::bit_floor(static_cast<unsigned>(wanted)), doubled_twice * least,
                           std::max(crowd.rays, doubled_twice * least));
    return by_rays.at(light, rest, places, scratch);
}

}  // namespace exitance

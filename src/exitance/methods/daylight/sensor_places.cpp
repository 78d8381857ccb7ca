#include "exitance/methods/daylight/sensor_places.hpp"

#include "exitance/scene/locator.hpp"

namespace exitance {

std::vector<Receiver> sensor_places(const Scene& scene, const Occluders& occluders,
                                    std::span<const ProbePoint> sensors) {
    const Locator locator(scene);
    std::vector<Receiver> out;
    for (const ProbePoint& sensor : sensors) {
        const SurfaceId s = locator.find(sensor.x, sensor.n);
        const RegionId own = s.is_none() ? RegionId() : scene.surfaces()[s].region;
        Point x = sensor.x;
        if (!own.is_none()) x -= (scene.regions()[own].plane.signed_distance(x) - occluders.lift(own)) * sensor.n;
        out.push_back({x, sensor.n, own});
    }
    return out;
}

}  // namespace exitance

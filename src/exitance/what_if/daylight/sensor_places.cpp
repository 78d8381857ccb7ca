#include "exitance/what_if/daylight/sensor_places.hpp"

#include "exitance/scene/place_finder.hpp"

namespace exitance {

std::vector<SurfacePoint> sensor_places(const Scene& scene, const Occluders& occluders,
                                        std::span<const ProbePoint> sensors) {
    const PlaceFinder places(scene);
    std::vector<SurfacePoint> out;
    for (const ProbePoint& sensor : sensors) {
        const MeasuredPlace place = places.find(sensor.x, sensor.n);
        Point x = place.x;
        if (!place.region.is_none())
            x -= (scene.regions()[place.region].plane.signed_distance(x) - occluders.lift(place.region)) * sensor.n;
        out.push_back({x, sensor.n, place.region});
    }
    return out;
}

}  // namespace exitance

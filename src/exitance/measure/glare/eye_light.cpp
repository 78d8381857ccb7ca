#include "exitance/measure/glare/eye_light.hpp"

#include <cmath>

#include "exitance/transport/stage.hpp"

namespace exitance {

Observer off_walls(const RadiosityFunction& light, const Observer& observer) {
    Observer out = observer;
    const MeasuredPlace place = light.places().find(observer.eye, observer.view);
    out.eye = place.x;
    if (!place.region.is_none())
        out.eye += light.places().step() * light.solution().scene.regions()[place.region].plane.n;
    return out;
}

double indirect_at_eye(const RadiosityFunction& light, const Observer& observer, const LightUnit& lux) {
    constexpr int places = 8;
    constexpr double step = 1e-3;  // metres
    const Frame frame(observer.view);
    std::vector<ProbePoint> points;
    for (int i = 0; i < places; ++i) {
        const double a = 2 * pi * i / places;
        const Point x = observer.eye + step * frame.to_world(std::cos(a), std::sin(a), 0);
        bool blocked = false;
        light.stage().tracer.occluded(std::span(&observer.eye, 1), std::span(&x, 1), RegionId(), RegionId(),
                                      std::span(&blocked, 1));
        points.push_back({blocked ? observer.eye : x, observer.view});
    }
    double sum = 0;
    for (const Light& there : light.at(points, Component::indirect)) sum += lux(there.irradiance) / places;
    return sum;
}

}  // namespace exitance

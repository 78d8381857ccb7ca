#include "exitance/error/clustering_error.hpp"

#include <cmath>

namespace exitance {

double clustering_error(const Stage& stage, const DirectProjection& direct, const LightAccuracy& accuracy) {
    constexpr double samples = 256;
    PlaceLight::Workspace workspace;
    double area = 0, squares = 0, taken = 0, next = 0.5 * stage.area / samples;
    for (ElementId e : direct.tree.leaves()) {
        area += direct.tree.area(e);
        if (area <= next) continue;
        const double steps = std::ceil((area - next) * samples / stage.area);
        next += steps * stage.area / samples, taken += steps;
        const RegionId region = direct.tree.region(e);
        const Point x = direct.tree.patch(e).at(direct.tree.centre(e));
        const double rho = mean(stage.scene.material(region).reflectance);
        const Normal& n = stage.scene.regions()[region].plane.n;
        squares += steps * rho * rho * stage.place_light.at(x, n, region, accuracy, workspace).variance;
    }
    return taken > 0 ? std::sqrt(squares / taken) : 0;
}

}  // namespace exitance

#include "exitance/error/clustering_error.hpp"

#include <cmath>

namespace exitance {

double clustering_error(const Stage& stage, const DirectProjection& direct, const LightAccuracy& accuracy) {
    if (!stage.clustered.is_possible()) return 0;
    constexpr double samples = 256;
    ClusteredLight::Workspace workspace;
    double area = 0, squares = 0, taken = 0, next = 0.5 * stage.area / samples;
    for (ElementId e : direct.tree.leaves()) {
        area += direct.tree.area(e);
        if (area <= next) continue;
        const double steps = std::ceil((area - next) * samples / stage.area);
        next += steps * stage.area / samples, taken += steps;
        const RegionId region = direct.tree.region(e);
        const Point x = direct.tree.patch(e).at(direct.tree.centre(e));
        if (!stage.clustered.pays(x, stage.scene.regions()[region].plane.n, region, accuracy, workspace)) continue;
        const Spectrum reflected = stage.scene.material(region).reflectance * direct.fit[e].mean;
        squares += steps * std::pow(accuracy.allowed(mean(reflected)), 2);
    }
    return taken > 0 ? std::sqrt(squares / taken) : 0;
}

}  // namespace exitance

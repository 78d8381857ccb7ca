#include "exitance/error/direct_light_noise.hpp"

#include <cmath>
#include <vector>

#include "exitance/base/parallel.hpp"

namespace exitance {

double direct_light_noise(const Stage& stage, const DirectProjection& direct, const LightAccuracy& accuracy) {
    constexpr double samples = 256;
    struct Sample {
        ElementId e;
        double weight;
    };
    std::vector<Sample> at;  // samples at equal steps of the cumulative area
    double area = 0, next = 0.5 * stage.area / samples;
    for (ElementId e : direct.tree.leaves()) {
        area += direct.tree.area(e);
        if (area <= next) continue;
        const double steps = std::ceil((area - next) * samples / stage.area);
        next += steps * stage.area / samples;
        at.push_back({e, steps});
    }
    std::vector<double> variance(at.size());
    parallel_ranges(at.size(), 4, [&](std::size_t first, std::size_t last) {
        PlaceLight::Workspace workspace;
        for (std::size_t i = first; i < last; ++i) {
            const RegionId region = direct.tree.region(at[i].e);
            const Point x = direct.tree.patch(at[i].e).at(direct.tree.centre(at[i].e));
            const double rho = mean(stage.scene.material(region).reflectance);
            const Normal& n = stage.scene.regions()[region].plane.n;
            variance[i] = rho * rho * stage.place_light.at(x, n, region, accuracy, workspace).variance;
        }
    });
    double squares = 0, taken = 0;
    for (std::size_t i = 0; i < at.size(); ++i) squares += at[i].weight * variance[i], taken += at[i].weight;
    return taken > 0 ? std::sqrt(squares / taken) : 0;
}

}  // namespace exitance

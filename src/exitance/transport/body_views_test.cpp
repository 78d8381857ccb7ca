#include "exitance/transport/body_views.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

const std::map<std::string, std::string> sunny{{"ground", "800"}, {"altitude", "40"}, {"azimuth", "160"}};

TEST(BodyViews, ShareOfRaysIsTheFormFactor) {
    // The underside of a roof sees only the ground, except for at most 1e-4 of its rays, which pass the ground's
    // border. The rim of the roof is 0.1 m high and sees the ground with half of its rays.
    const Scene scene = built_scene("canopy", {{"size", "4"}});
    const Stage stage(scene);
    const SceneBodies bodies = find_bodies(scene);
    const BodyViews views(stage, bodies, 1);
    std::vector<double> weight(bodies.all.size());
    for (const BodyViews::Hit& hit : views.hits()) weight[hit.body] += hit.weight;
    const double underside = 16, rim = 4 * 4 * 0.1;
    std::size_t found = 0;
    for (std::size_t b = 0; b < bodies.all.size(); ++b) {
        if (std::abs(bodies.all[b].area - underside - rim) > 1e-6) continue;
        ++found;
        EXPECT_NEAR(weight[b], 0.7 * (underside + 0.5 * rim) / (underside + rim), 0.01);
    }
    EXPECT_EQ(found, 1u);
}

/// Largest relative error of the light that a body gets by one reflection, if the projected direct light replaces the
/// exact one.
double worst_of_bodies(const Scene& scene, double body_tolerance) {
    const Stage stage(scene);
    const SceneBodies bodies = find_bodies(scene);
    const BodyViews views(stage, bodies, 1), others(stage, bodies, 2);
    const std::vector<double> tolerance(bodies.all.size(), body_tolerance);
    const DirectProjection light = project_direct_light(stage,
                                                        {.mesh = {100, 0},
                                                         .tolerance = 0.08,
                                                         .bodies = body_tolerance > 0 ? &views : nullptr,
                                                         .body_tolerance = tolerance},
                                                        {});
    const ElementLocator locator(light.tree, scene.regions().size());
    std::vector<double> exact(bodies.all.size()), projected(bodies.all.size());
    DirectLight::Workspace room;
    for (const BodyViews::Hit& hit : others.hits()) {
        const double rho = mean(scene.material(hit.region).reflectance);
        const Normal& n = scene.regions()[hit.region].plane.n;
        exact[hit.body] += hit.weight * rho * mean(stage.direct.irradiance(hit.y, n, hit.region, room));
        projected[hit.body] += hit.weight * rho * mean(light.at(locator.find(hit.region, hit.y)));
    }
    double worst = 0;
    for (std::size_t b = 0; b < exact.size(); ++b)
        if (exact[b] > 0) worst = std::max(worst, std::abs(projected[b] - exact[b]) / exact[b]);
    return worst;
}

TEST(BodyNeeds, RefineTheLightThatASmallBodyReceives) {
    // Roofs of 1 to 256 m^2 above 640,000 m^2 of ground, on a mesh whose elements do not show their shadows. One
    // element may be wrong by the tolerance; several, each of which may be, by up to three times as much.
    const double tolerance = 0.03;
    for (const char* size : {"1", "4", "16"})
        for (const char* sun : {"1", "0"}) {
            std::map<std::string, std::string> values = sunny;
            values["size"] = size, values["sun"] = sun, values["roofs"] = "2";
            EXPECT_LT(worst_of_bodies(built_scene("canopy", values), tolerance), 3 * tolerance) << size << " " << sun;
        }
    EXPECT_GT(worst_of_bodies(built_scene("canopy", sunny), 0), tolerance) << "without needs, the light is wrong";
}

}  // namespace
}  // namespace exitance

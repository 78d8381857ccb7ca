#include "exitance/direct/shared_rays.hpp"

#include <gtest/gtest.h>

#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Two furnished rooms, one below a panel of 96 emitting triangles: from most points some of them are hidden.
struct Panel {
    Panel() : scene(built_scene("carpet", {{"u", "12"}, {"v", "8"}, {"cuts", "1"}, {"books", "0"}})), stage(scene) {}
    Scene scene;
    Stage stage;
    DirectLight::Workspace workspace;
};

/// 49 points in a triangle.
std::vector<Point> places_on(std::span<const Point> corners) {
    std::vector<Point> out;
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 7; ++k) {
            double u = (i + 0.5) / 7, v = (k + 0.4) / 7;
            if (u + v > 1) u = 1 - u, v = 1 - v;
            out.push_back(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]));
        }
    return out;
}

TEST(SharedRays, DifferFromExactLightByAtMostTheAllowedError) {
    Panel panel;
    const DirectLight& direct = panel.stage.direct;
    SharedRays shared(direct, panel.stage.tracer);
    ASSERT_TRUE(shared.is_possible());
    for (const double asked : {0.05, 0.01}) {
        const LightAccuracy accuracy{asked, 0.1 * asked};  // W/m^2; the irradiance is between 0 and 8
        ReceiverLight whole;
        SharedRays::Part part;
        double miss = 0, allowed = 0, told = 0;
        std::size_t faces = 0, rays = 0, places_seen = 0;
        for (const SurfaceId s : panel.scene.surfaces().ids()) {
            const Surface& surface = panel.scene.surfaces()[s];
            const std::span<const Point> outline = panel.scene.outline(s);
            if (surface.area < 0.3 || outline.size() != 3) continue;
            direct.prepare(outline, surface.normal, surface.region, whole, panel.workspace);
            const std::vector<Point> places = places_on(outline);
            shared.choose(whole, std::span(places).first(9), 1);
            if (!shared.share(whole, places[24], accuracy, part, panel.workspace)) continue;
            ++faces;
            for (std::uint32_t i = 0; i < places.size(); ++i) {
                const double exact = mean(direct.irradiance(whole, places[i], panel.workspace));
                const ClusteredLight::Estimate found = shared.at(part, places[i], i, accuracy, panel.workspace);
                miss += std::pow(mean(found.irradiance) - exact, 2), told += found.variance;
                allowed += std::pow(accuracy.allowed(exact), 2), rays += found.rays, ++places_seen;
            }
        }
        EXPECT_GT(faces, 10u);
        EXPECT_LT(miss, 1.5 * told);  // compared with the reported error
        // An eighth of the thousand available rays per point would be sufficient, except for nearly dark points.
        EXPECT_LT(static_cast<double>(rays) / static_cast<double>(places_seen), 500.0);
        // Some points that use all available rays have larger errors.
        EXPECT_LT(miss, (asked == 0.05 ? 1 : 2) * allowed);
    }
}

TEST(SharedRays, SkipHiddenAndFullyVisibleSourcesOfAPart) {
    Panel panel;
    const DirectLight& direct = panel.stage.direct;
    SharedRays shared(direct, panel.stage.tracer);
    // Above the floor near the door of the dark room: many of the lamps are certainly hidden.
    constexpr double h = 0.01;  // metres
    ReceiverLight whole, light;
    const std::vector<Point> wide = {{4.2, 0.3, h}, {5.4, 0.3, h}, {5.4, 1.5, h}, {4.2, 1.5, h}};
    const std::vector<Point> narrow = {{4.3, 0.9, h}, {4.4, 0.9, h}, {4.4, 1.0, h}, {4.3, 1.0, h}};
    const Normal up{0, 0, 1};
    direct.prepare(wide, up, RegionId(), whole, panel.workspace);
    direct.prepare(narrow, whole, light, panel.workspace);
    shared.choose(whole, wide, 1);
    SharedRays::Part part;
    ASSERT_TRUE(shared.share(light, narrow[0], {0.02, 0}, part, panel.workspace));
    EXPECT_LE(part.shadowed.size() + part.exact.sources.size(), light.sources.size());
    const Point x{4.35, 0.95, h};
    const ClusteredLight::Estimate found = shared.at(part, x, 3, {0.02, 0}, panel.workspace);
    const double exact = mean(direct.irradiance(light, x, panel.workspace));
    // Probability of a larger deviation: 1e-4.
    EXPECT_NEAR(mean(found.irradiance), exact, 4 * std::sqrt(found.variance));
    // The result for a point and set does not depend on the calls in between.
    shared.at(part, narrow[2], 7, {0.02, 0}, panel.workspace);
    EXPECT_EQ(shared.at(part, x, 3, {0.02, 0}, panel.workspace).irradiance, found.irradiance);
}

}  // namespace
}  // namespace exitance

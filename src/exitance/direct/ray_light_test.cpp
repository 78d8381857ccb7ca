// Direct light by rays and by the cheaper estimator, compared with exact light.
#include "exitance/direct/ray_light.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/error/area_samples.hpp"
#include "exitance/scene/locator.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"
#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// Ground below tilted slats, turned and moved; under any distant light and panes, with a lamp above.
Scene slats(const DistantLight& light, std::vector<Pane> panes = {}, double lamp = 0) {
    SceneDescription d;
    d.file = "slats.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}, {"lamp", Spectrum(0.0), Spectrum(lamp)}};
    d.groups = {"all"};
    const auto face = [&](const std::vector<Point>& corners, std::uint32_t material) {
        const auto place = [](const Point& p) {
            return Point{0.8 * p.x - 0.6 * p.y + 3, 0.6 * p.x + 0.8 * p.y - 2, p.z};
        };
        add_polygon(d, corners, place).material = material;
    };
    face({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, 0);
    for (int i = 0; i < 40; ++i) {
        const double x = -4 + 0.2 * i, z = 1 + 0.02 * (i % 7);
        face({{x, -4, z}, {x + 0.1, -4, z + 0.05}, {x + 0.1, 4, z + 0.05}, {x, 4, z}}, 0);
    }
    if (lamp > 0) face({{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, 1);
    d.distant = light, d.panes = std::move(panes);
    return checked_scene(std::move(d));
}

Point ground_at(double x, double y) {
    return {0.8 * x - 0.6 * y + 3, 0.6 * x + 0.8 * y - 2, 0};
}

struct Comparison {
    double bias = 0, squares = 0, variance = 0, exact = 0, rays = 0, count = 0;
};

/// Light on the ground by rays, less exact light.
Comparison compare(const Stage& stage, const LightAccuracy& accuracy) {
    Comparison out;
    PlaceLight::Workspace room;
    const RegionId ground(0);
    const Normal up = stage.scene.regions()[ground].plane.n;
    for (double x = -3; x < 3; x += 0.37)
        for (double y = -3; y < 3; y += 0.43) {
            const Point at = ground_at(x, y);
            const double exact = mean(stage.direct.irradiance(at, up, ground, room.exact));
            const RayLight::Estimate found = stage.place_light.rays().at(at, up, ground, accuracy, room);
            const double error = mean(found.irradiance) - exact;
            out.bias += error, out.squares += error * error, out.variance += found.variance, out.exact += exact;
            out.rays += static_cast<double>(found.rays), ++out.count;
        }
    return out;
}

DistantLight under(SkyModel sky, double sun) {
    EXPECT_TRUE(sky.normalize());
    DistantLight out{{{sky, Spectrum(100.0)}}, {}};
    if (sun > 0) out.discs.push_back({sky_direction(50, 200), sun_half_angle, Spectrum(sun)});
    return out;
}

TEST(RayLight, AgreesWithExactLightOfSkiesSunAndLamps) {
    const Normal sun = sky_direction(35, 200);
    const std::vector<DistantLight> lights = {under(uniform_sky(), 0), under(overcast_sky(), 0),
                                              under(cie_sky(12, sun), 200), under(perez_sky({90, 700, 100}, sun), 500)};
    for (std::size_t i = 0; i < 2 * lights.size(); ++i) {
        const Scene scene = slats(lights[i / 2], {}, i % 2 == 0 ? 0.0 : 400.0);
        const Stage stage(scene);
        const Comparison c = compare(stage, {.relative = 0.02});
        // The mean over 238 places is the exact light within three standard errors, and 0.1% for that of exact light.
        EXPECT_LT(std::abs(c.bias), 3 * std::sqrt(c.variance) + 1e-3 * c.exact) << i;
        EXPECT_LT(c.squares, 1.5 * c.variance) << i;
        // Accuracies are relative to the light of a place, or to a twentieth of its unoccluded light.
        EXPECT_LT(c.variance, 1.3 * std::pow(0.02 * c.exact, 2) / c.count) << i;
    }
}

TEST(RayLight, AgreesWithExactLightThroughCleanPanesOfAnyColour) {
    Pane pane;
    for (const auto& [x, y] : {std::pair(-3, -3), std::pair(-3, 3), std::pair(3, 3), std::pair(3, -3)})
        pane.corners.push_back(ground_at(x, y) + Vec3{0, 0, 3});
    pane.transmissivity = Spectrum(0.3);
    pane.transmissivity[0] = 0.9;
    const Scene scene = slats(under(overcast_sky(), 0), {pane});
    const Stage stage(scene);
    PlaceLight::Workspace room;
    const RegionId ground(0);
    const Normal up = stage.scene.regions()[ground].plane.n;
    Spectrum exact, found;
    double variance = 0;
    for (double x = -3; x < 3; x += 0.37)
        for (double y = -3; y < 3; y += 0.43) {
            const Point at = ground_at(x, y);
            exact += stage.direct.irradiance(at, up, ground, room.exact);
            const RayLight::Estimate e = stage.place_light.rays().at(at, up, ground, {.relative = 0.02}, room);
            found += e.irradiance, variance += e.variance;
        }
    // A single band is noisier than the mean of three, by less than a factor of two.
    for (std::size_t b = 0; b < bands; ++b)
        EXPECT_NEAR(found[b], exact[b], 6 * std::sqrt(variance) + 1e-3 * exact[b]) << b;
}

TEST(RayLight, ErrorFallsAsStratificationPromises) {
    SkyModel sky = cie_sky(12, sky_direction(35, 200));
    const Scene scene = slats(under(sky, 0));
    const Stage stage(scene);
    const Comparison coarse = compare(stage, {.relative = 0.04}), fine = compare(stage, {.relative = 0.0025});
    const double of_error = 0.5 * std::log(coarse.squares / fine.squares), of_rays = std::log(fine.rays / coarse.rays);
    EXPECT_GT(of_rays, std::log(8.0));
    EXPECT_GT(of_error, 0.65 * of_rays);  // n^(-3/4) in theory, n^(-1/2) without stratification
}

TEST(RayLight, AgreesWithExactLightOfManyEmitters) {
    // Two furnished rooms, one below a panel of 400 emitting triangles.
    const Scene scene = built_scene("carpet", {{"u", "20"}, {"v", "10"}, {"cuts", "1"}, {"books", "0"}});
    const Stage stage(scene);
    PlaceLight::Workspace room;
    const Locator locator(scene);
    for (const double asked : {0.1, 0.01}) {
        double bias = 0, squares = 0, variance = 0, allowed = 0, all = 0, rays = 0, count = 0;
        for (const ProbePoint& p : points_uniform_in_area(scene, 150, 3)) {
            const SurfaceId surface = locator.find(p.x, p.n);
            if (surface.is_none()) continue;
            const RegionId region = scene.surfaces()[surface].region;
            const double exact = mean(stage.direct.irradiance(p.x, p.n, region, room.exact));
            const double absolute = 0.1 * asked;  // W/m^2; the irradiance is between 0 and 8
            const RayLight::Estimate found = stage.place_light.rays().at(p.x, p.n, region, {asked, absolute}, room);
            bias += mean(found.irradiance) - exact, squares += std::pow(mean(found.irradiance) - exact, 2);
            variance += found.variance, allowed += std::pow(asked * exact + absolute, 2);
            all += exact, rays += static_cast<double>(found.rays), ++count;
        }
        EXPECT_GT(all / count, 0.2);
        EXPECT_LT(std::abs(bias), 3 * std::sqrt(variance));
        EXPECT_LT(squares, 1.5 * variance);
        EXPECT_LT(squares, allowed);
        EXPECT_LT(rays / count, 25 / asked);  // the number of rays grows at most in proportion to the accuracy
    }
}

TEST(RayLight, DependsOnThePlaceAlone) {
    SkyModel sky = cie_sky(12, sky_direction(35, 200));
    const Scene scene = slats(under(sky, 300), {}, 100);
    const Stage stage(scene);
    PlaceLight::Workspace room, other;
    const auto look = [&](double x, PlaceLight::Workspace& in) {
        return stage.place_light.rays()
            .at(ground_at(x, 0.3), {0, 0, 1}, RegionId(0), {.relative = 0.02}, in)
            .irradiance;
    };
    const Spectrum first = look(0.1, room);
    EXPECT_NE(look(0.2, room), first);
    EXPECT_EQ(look(0.1, room), first);
    EXPECT_EQ(look(0.1, other), first);
}

TEST(PlaceLight, IsExactWhereThatIsCheaper) {
    const Scene scene = built_scene("office", {{"nx", "2"}, {"ny", "1"}, {"nfurn", "1"}});
    const Stage stage(scene);
    PlaceLight::Workspace room;
    const Point x{2, 2, 0};
    const PlaceLight::Estimate found = stage.place_light.at(x, {0, 0, 1}, RegionId(), {.relative = 0.001}, room);
    EXPECT_EQ(found.irradiance, stage.direct.irradiance(x, {0, 0, 1}, RegionId(), room.exact));
    EXPECT_EQ(found.variance, 0);
    EXPECT_EQ(found.rays, 0u);
}

TEST(PlaceLight, UsesRaysBeforeManyBlockersAndExactLightIfNoErrorIsAllowed) {
    const Scene scene = built_scene("clutter", {{"n", "2000"}});
    const Stage stage(scene);
    PlaceLight::Workspace room;
    const RegionId floor = scene.surfaces()[SurfaceId(0)].region;
    const Normal n = scene.regions()[floor].plane.n;
    double rays = 0, bias = 0, variance = 0;
    for (double x = 0.3; x < 3.8; x += 0.4)
        for (double y = 0.3; y < 3.8; y += 0.4) {
            const Point at{x, y, 0};
            const PlaceLight::Estimate found = stage.place_light.at(at, n, floor, {.relative = 0.01}, room),
                                       exact = stage.place_light.at(at, n, floor, {}, room);
            EXPECT_EQ(exact.rays, 0u);
            rays += static_cast<double>(found.rays), variance += found.variance;
            bias += mean(found.irradiance) - mean(exact.irradiance);
        }
    EXPECT_GT(rays, 0);
    EXPECT_LT(std::abs(bias), 3 * std::sqrt(variance));
}

TEST(PlaceLight, PlacesOfAPolygonHaveTheLightOfSinglePlaces) {
    for (const char* triangles : {"0", "500"}) {
        const Scene scene = built_scene("clutter", {{"n", triangles}});
        const Stage stage(scene);
        PlaceLight::Workspace room;
        const RegionId floor = scene.surfaces()[SurfaceId(0)].region;
        const Region& region = scene.regions()[floor];
        std::vector<Point> places;
        for (double x = 0.3; x < 3.8; x += 0.4) places.push_back({x, 1.7, 0});
        std::vector<PlaceLight::Estimate> found;
        stage.place_light.at_places({region.loops[0], region.plane.n, floor, places}, {0, 0.02}, room, found);
        ASSERT_EQ(found.size(), places.size());
        double squares = 0, variance = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Spectrum exact = stage.direct.irradiance(places[i], region.plane.n, floor, room.exact);
            squares += std::pow(mean(found[i].irradiance - exact), 2), variance += found[i].variance;
        }
        // with probability 99%, a sum of ten squares is below 2.4 times its mean
        EXPECT_LE(squares, 3 * variance + 1e-18) << triangles;
        EXPECT_LT(variance, 1.2 * 0.02 * 0.02 * static_cast<double>(places.size())) << triangles;
    }
}

}  // namespace
}  // namespace exitance

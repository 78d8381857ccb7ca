#include "exitance/direct/crowded_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// The floor below thin triangles and a lamp, as one receiver.
struct Floor {
    explicit Floor(const char* triangles = "60") : scene(built_scene("clutter", {{"n", triangles}})) {
        region = stage.scene.surfaces()[SurfaceId(0)].region;
        n = stage.scene.regions()[region].plane.n;
        stage.direct.prepare(outline(), n, region, light, room);
    }
    std::span<const Point> outline() const { return stage.scene.regions()[region].loops[0]; }
    /// Sources left to rays with an allowed mean square noise; all others are in `rest`.
    CrowdedLight::Crowd crowd(double allowed, ReceiverLight& rest) {
        return stage.crowded.prepare(outline(), n, region, allowed, rest, room);
    }

    const Scene scene;
    const Stage stage{scene};
    RegionId region;
    Normal n;
    ReceiverLight light;
    DirectLight::Workspace room;
};

std::vector<Point> grid_of_places() {
    std::vector<Point> out;
    for (double x = 0.1; x < 4; x += 0.2)
        for (double y = 0.1; y < 4; y += 0.2) out.push_back({x, y, 0});
    return out;
}

TEST(CrowdedLight, DiffersFromExactLightByItsNoise) {
    Floor floor;
    constexpr double allowed = 0.01;
    ReceiverLight rest;
    const CrowdedLight::Crowd crowd = floor.crowd(allowed, rest);
    ASSERT_EQ(crowd.sources.size(), 1u);
    EXPECT_TRUE(rest.sources.empty());
    const std::vector<Point> places = grid_of_places();
    const std::vector<CrowdedLight::Estimate> by_rays = floor.stage.crowded.at(rest, crowd, places, floor.room);
    double sum = 0, squares = 0, variance = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Spectrum exact = floor.stage.direct.irradiance(floor.light, places[i], floor.room);
        const double error = mean(by_rays[i].irradiance) - mean(exact);
        sum += error, squares += error * error, variance += by_rays[i].variance;
    }
    const double count = static_cast<double>(places.size());
    // Evenly spread rays are better than their quarters suggest; 400 points estimate a variance to about a tenth.
    EXPECT_LT(squares, 1.3 * variance);
    EXPECT_LT(variance / count, allowed);
    EXPECT_LT(std::abs(sum), 3 * std::sqrt(variance));
}

TEST(CrowdedLight, KeepsAllSourcesExactIfNoNoiseIsAllowed) {
    Floor floor;
    for (const double allowed : {0.0, 1e-9}) {
        ReceiverLight rest;
        EXPECT_TRUE(floor.crowd(allowed, rest).empty());
        ASSERT_EQ(rest.sources.size(), 1u);
        EXPECT_EQ(rest.sources[0].count, floor.light.sources[0].count);
    }
}

TEST(CrowdedLight, StopsCountingCandidatesAtTheCostOfRays) {
    for (const char* triangles : {"500", "2000"}) {
        Floor floor(triangles);
        ReceiverLight rest;
        const CrowdedLight::Crowd crowd = floor.crowd(1, rest);
        ASSERT_EQ(crowd.sources.size(), 1u);
        EXPECT_GT(floor.light.sources[0].count, 300u);
        EXPECT_TRUE(crowd.sources[0].source.is_crowded);
        EXPECT_LE(crowd.sources[0].source.count, crowd.rays);
    }
}

TEST(CrowdedLight, CastsNoMoreRaysToManySourcesThanTheirCandidatesCost) {
    // Windows and lamps share the allowed noise, so that each needs more rays than it would alone.
    const Scene scene = built_scene("office", {{"nx", "1"}, {"ny", "2"}});
    const Stage stage(scene);
    DirectLight::Workspace room;
    ReceiverLight rest;
    std::size_t several = 0;
    for (const RegionId r : scene.regions().ids()) {
        const Region& region = scene.regions()[r];
        if (region.area < 1) continue;
        for (const double allowed : {1e-2, 1e-3, 1e-4}) {
            const CrowdedLight::Crowd crowd =
                stage.crowded.prepare(region.loops[0], region.plane.n, r, allowed, rest, room);
            several += crowd.sources.size() > 1;
            for (const CrowdedLight::Crowd::Source& s : crowd.sources)
                EXPECT_GE(6 * s.source.count, crowd.rays) << allowed;
        }
    }
    EXPECT_GE(several, 3u);
}

TEST(CrowdedLight, HasIndependentErrorsAtNeighbouringPoints) {
    // Otherwise the mean over an element would be worse than the variances indicate, and its error would be mistaken
    // for a feature.
    Floor floor("500");
    ReceiverLight rest;
    const CrowdedLight::Crowd crowd = floor.crowd(0.1, rest);
    double together = 0, apart = 0;
    for (int column = 4; column < 80; ++column) {  // excluding walls, where exact light has no corresponding ray
        std::vector<Point> places;
        for (int k = 0; k < 9; ++k) places.push_back({0.05 * column, 2 + 0.001 * k, 0});
        double error = 0;
        const std::vector<CrowdedLight::Estimate> by_rays = floor.stage.crowded.at(rest, crowd, places, floor.room);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Spectrum exact = floor.stage.direct.irradiance(floor.light, places[i], floor.room);
            error += (mean(by_rays[i].irradiance) - mean(exact)) / 9, apart += by_rays[i].variance / 81;
        }
        together += error * error;
    }
    // 76 squares estimate a variance to a sixth; three times that. If errors were equal: 9 times.
    EXPECT_LT(together, 1.5 * apart);
}

TEST(CrowdedLight, ReportsItsVariance) {
    // Uses one point 200 times, moved by tiny amounts: the random points on the lamp differ, the exact light does not.
    Floor floor("500");
    ReceiverLight rest;
    const CrowdedLight::Crowd crowd = floor.crowd(0.1, rest);
    double squares = 0, told = 0;
    for (double x = 0.2; x < 3.9; x += 0.4) {
        std::vector<Point> places;
        for (int k = 0; k < 200; ++k) places.push_back({x + 1e-9 * k, 2, 0});
        const double exact = mean(floor.stage.direct.irradiance(floor.light, places[0], floor.room));
        for (const CrowdedLight::Estimate& at : floor.stage.crowded.at(rest, crowd, places, floor.room))
            squares += std::pow(mean(at.irradiance) - exact, 2), told += at.variance;
    }
    // With 2,000 squares the mean is known to a thirtieth, or to a tenth if a few of them dominate.
    EXPECT_NEAR(squares / told, 1, 0.25);
}

/// A lamp of 3 x 2 m, 7 cm above a grid of intersecting upright plates with two sides each.
SceneDescription lamp_over_grid() {
    SceneDescription d;
    d.materials = {{"grey", Spectrum(0.4), Spectrum(0.0)}, {"lamp", Spectrum(0.0), Spectrum(60.0)}};
    d.groups = {"all"};
    const auto face = [&](std::vector<Point> corners, std::uint32_t material) {
        SceneDescription::Face f;
        for (const Point& p : corners) {
            f.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        f.material = material;
        d.faces.push_back(f);
    };
    const auto plate = [&](const Point& a, const Point& b) {
        const Vec3 up{0, 0, 0.08};
        face({a, b, b + up, a + up}, 0), face({a + up, b + up, b, a}, 0);
    };
    face({{1, 1, 2.95}, {1, 3, 2.95}, {4, 3, 2.95}, {4, 1, 2.95}}, 1);
    for (int i = 0; i <= 20; ++i) {
        plate({1 + 0.15 * i, 1, 2.8}, {1 + 0.15 * i, 3, 2.8});
        plate({1, 1 + 0.1 * i, 2.8}, {4, 1 + 0.1 * i, 2.8});
    }
    return d;
}

TEST(CrowdedLight, OfALargeLampNearbyIsWhatTheNearPartBrings) {
    // A plate is illuminated only by the part of the lamp above its own cell: 1% of the area and most of the light.
    const Scene scene = std::move(*make_scene(lamp_over_grid()).scene);
    const Stage stage(scene);
    DirectLight::Workspace room;
    double sum = 0, exact = 0, variance = 0;
    std::size_t crowds = 0;
    for (int k = 0; k < 19; ++k) {
        const SurfaceId plate(1 + 4 * 10);  // at x = 2.5
        const RegionId own = scene.surfaces()[plate].region;
        const Normal n = scene.regions()[own].plane.n;
        const double y = 1 + 0.1 * k, x = 2.5;
        std::vector<Point> cell{{x, y, 2.8}, {x, y + 0.1, 2.8}, {x, y + 0.1, 2.88}, {x, y, 2.88}};
        if (dot(area_vector(cell), n) < 0) std::reverse(cell.begin(), cell.end());
        ReceiverLight rest, whole;
        const CrowdedLight::Crowd crowd = stage.crowded.prepare(cell, n, own, 4, rest, room);
        crowds += !crowd.empty();
        stage.direct.prepare(cell, n, own, whole, room);
        const std::vector<Point> places{{x, y + 0.03, 2.81}, {x, y + 0.05, 2.84}, {x, y + 0.08, 2.87}};
        const std::vector<CrowdedLight::Estimate> by_rays = stage.crowded.at(rest, crowd, places, room);
        for (std::size_t i = 0; i < places.size(); ++i) {
            sum += mean(by_rays[i].irradiance + stage.direct.irradiance(rest, places[i], room));
            variance += by_rays[i].variance;
            exact += mean(stage.direct.irradiance(whole, places[i], room));
        }
    }
    EXPECT_GE(crowds, 10u);
    EXPECT_NEAR(sum, exact, 3 * std::sqrt(variance));
    EXPECT_LT(std::sqrt(variance), 0.05 * exact) << "else the test tells nothing";
}

}  // namespace
}  // namespace exitance

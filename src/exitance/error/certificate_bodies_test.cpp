#include "exitance/error/body_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/planted_error.hpp"

namespace exitance {
namespace {

using test::bright_and_dark_furnace, test::PlantedError, test::rough;

/// An error only in the bright room.
double rough_where_bright(const Point& p) {
    return p.x < 4 ? 3 * rough(p) : 0;
}

TEST(Certificate, DoesNotAddNoiseOfABrightRoomToADarkOne) {
    const PlantedError planted(rough_where_bright, 0.25, bright_and_dark_furnace());
    ASSERT_EQ(planted.stage.rooms.count(), 2u);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const std::vector<RoomError> rooms = planted.rooms(seed);
        EXPECT_GT(rooms[0].error, 0.05);
        // The noise of the bright room is a few percent of its light, and several times the light of the dark room.
        EXPECT_LT(rooms[1].error, 0.05);
    }
}

TEST(Certificate, FindsAnErrorOfTheProjectionInADarkRoom) {
    // The projection is wrong as in WrongProjection, but only in the dark room.
    constexpr double factor = 1.2, truth = (factor - 1) / 2;
    const PlantedError planted([](const Point& p) { return p.x < 4 ? 0 : factor - 1; }, 0.25,
                               bright_and_dark_furnace());
    ASSERT_EQ(planted.stage.rooms.count(), 2u);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    const auto told = [&](RegionId region, const Point& y) { return planted.emitted(region) * (y.x < 4 ? 1 : factor); };
    const PointwiseLight projected([&](RegionId region, const Point& y) { return Spectrum(told(region, y)); });
    const PointwiseLight b([&](RegionId region, const Point& y) {
        return Spectrum(planted.rho * (told(region, y) + mean(planted.delivered.at(locator.find(region, y)))));
    });
    const std::vector<double> light_in = planted.light_by_room();
    constexpr int seeds = 8;
    double square = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        CertificateOptions options{.error = 0.02, .seed = seed, .light_in = light_in, .allowed_in = light_in};
        options.projected = {&projected, Spectrum(1.0)};
        Certifier certifier(planted.stage, planted.light, planted.delivered, b, options);
        certifier.measure();
        square += std::pow(certifier.rooms()[1].error / truth - 1, 2) / seeds;
    }
    // Checks as rare as the light of the bright room allows would have several times as much noise.
    EXPECT_LT(std::sqrt(square), 0.1);
}

/// Two separate cubes with uniform light inside, with edges of `large` and `small` metres, the second at x = `at`.
Scene large_and_small_furnace(double large, double small, double at) {
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), Spectrum(1.0)}};
    d.groups = {"large", "small"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::uint32_t k = 0; k < 2; ++k) {
        const double x = at * k, size = k == 0 ? large : small;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, 0, z}, {x + size, 0, z}, {x + size, size, z}, {x, size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * k;
            d.faces.push_back({face, 0, k, 1});
        }
    }
    return std::move(*make_scene(std::move(d)).scene);
}

/// Two separate furnaces, the second with 1/64 of the first one's area, and a constant error only in the second.
TEST(Certificate, MeasuresSmallBodiesAtAdditionalPoints) {
    PlantedError planted([](const Point& p) { return p.x > 18 ? 0.2 : 0.0; }, 1, large_and_small_furnace(16, 2, 20));
    planted.stage.rooms = {};  // treat the scene as one room
    const SceneBodies bodies = find_bodies(planted.scene);
    ASSERT_EQ(bodies.all.size(), 2u);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    const PointwiseLight b(
        [&](RegionId region, const Point& y) { return Spectrum(planted.reflected(locator, region, y)); });
    const PointwiseLight direct([](RegionId, const Point&) { return Spectrum(1.0); });
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CertificateOptions options{.error = 0.02, .seed = seed};
        options.bodies = &bodies, options.projected = {&direct};
        Certifier certifier(planted.stage, planted.light, planted.delivered, b, options);
        Certificate found = certifier.measure();
        certifier.check_by_paths(found), certifier.measure_each_body(found);
        ASSERT_EQ(certifier.bodies().size(), 2u);
        EXPECT_GE(certifier.bodies()[1].points, 8u);
        ASSERT_TRUE(found.worst_body);
        // E_ind is 1.2 instead of 1. The error is relative to the body's mean reflected radiosity, which includes it:
        // 0.1 / 1.1.
        EXPECT_NEAR(*found.worst_body, 0.1 / 1.1, 0.15 * 0.1);
        EXPECT_LT(certifier.bodies()[0].error.value_or(1), 0.01);
        EXPECT_LT(found.estimate, 0.03);  // weighted by area, the error is negligible
    }
}

/// Two furnaces with the same rough error. No rays are left for the bodies, so that the points of the whole scene give
/// their errors.
TEST(Certificate, BodiesWithoutPointsOfTheirOwnHaveTheErrorAtThePointsOfTheScene) {
    PlantedError planted(rough, 0.5, large_and_small_furnace(2, 0.25, 4));
    planted.stage.rooms = {};  // treat the scene as one room
    const SceneBodies bodies = find_bodies(planted.scene);
    ASSERT_EQ(bodies.all.size(), 2u);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    const PointwiseLight b(
        [&](RegionId region, const Point& y) { return Spectrum(planted.reflected(locator, region, y)); });
    const PointwiseLight direct([](RegionId, const Point&) { return Spectrum(1.0); });
    CertificateOptions options{.error = 0.02, .check_rays = 1};
    options.bodies = &bodies, options.projected = {&direct};
    Certifier certifier(planted.stage, planted.light, planted.delivered, b, options);
    Certificate found = certifier.measure();
    certifier.measure_each_body(found);
    const BodyError &large = certifier.bodies()[0], &small = certifier.bodies()[1];
    ASSERT_TRUE(large.error);
    EXPECT_GE(large.points, BodyAtPoints::min_points);
    EXPECT_NEAR(*large.error, found.estimate, 0.1 * found.estimate);  // it has 98% of the area
    EXPECT_FALSE(small.error) << "a fiftieth of the points is too few";
}

/// Forty-nine separate furnaces with the same error. Rays hit rare bright speckles, so that eight points with few rays
/// make some of so many bodies seem far worse than they are.
TEST(Certificate, LooksCloselyAtEveryBodyThatMayExceedTheLimit) {
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), Spectrum(1.0)}};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    constexpr std::uint32_t bodies_a_row = 7, count = bodies_a_row * bodies_a_row;
    for (std::uint32_t k = 0; k < count; ++k) {
        d.groups.push_back("body " + std::to_string(k));
        const double x = 5 * (k % bodies_a_row), y = 5 * (k / bodies_a_row), size = 2;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, y, z}, {x + size, y, z}, {x + size, y + size, z}, {x, y + size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * k;
            d.faces.push_back({face, 0, k, 1});
        }
    }
    PlantedError planted(rough, 0.5, std::move(*make_scene(d).scene));
    planted.stage.rooms = {};  // treat the scene as one room
    const SceneBodies bodies = find_bodies(planted.scene);
    ASSERT_EQ(bodies.all.size(), count);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    // One cell of 2 cm in fifty holds all of the light that the other cells lack.
    const auto speckles = [](const Point& p) {
        constexpr double share = 0.02, size = 0.02, lacking = 0.2;
        const auto cell = [](double x) {
            return static_cast<std::uint64_t>(std::llround(std::floor(x / size + 1e-6)));
        };
        const bool is_bright = hash(cell(p.x), cell(p.y), cell(p.z)) % 1000 < 1000 * share;
        return lacking * ((is_bright ? 1 / share : 0) - 1);
    };
    const PointwiseLight b([&](RegionId region, const Point& y) {
        return Spectrum(planted.rho * (planted.emitted(region) + planted.exact) + speckles(y));
    });
    const PointwiseLight direct([](RegionId, const Point&) { return Spectrum(1.0); });
    const double truth = planted.error(rough);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CertificateOptions options{.error = 0.02, .seed = seed, .check_rays = count << 15};
        options.bodies = &bodies, options.projected = {&direct};
        Certifier certifier(planted.stage, planted.light, planted.delivered, b, options);
        Certificate found = certifier.measure();
        certifier.check_by_paths(found), certifier.measure_each_body(found);
        // Eight points do not suffice to say that a body exceeds the limit.
        std::size_t close = 0;
        for (const BodyError& body : certifier.bodies()) {
            close += body.points > BodyMeasure::min_points;
            const bool exceeds = body.error.value_or(0) > max_body_errors * options.error;
            EXPECT_TRUE(!exceeds || body.points > BodyMeasure::min_points);
        }
        EXPECT_GT(close, count / 3) << "one body must not take the rays of all";
        ASSERT_TRUE(found.worst_body);
        EXPECT_GT(*found.worst_body, truth);
        EXPECT_LT(*found.worst_body, 2 * truth);
    }
}

/// A box with a strip of a twentieth of its area that is thirty times as bright as the rest.
TEST(Certificate, MeansOfBodiesCountBrightStripsByTheirArea) {
    const auto bright = [](const Point& p) { return p.z < 0.25 ? 29.0 : 0.0; };
    const PlantedError planted(bright, 0.25, bright_and_dark_furnace());
    const SceneBodies bodies = find_bodies(planted.scene);
    ASSERT_EQ(bodies.all.size(), 2u);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    const PointwiseLight b(
        [&](RegionId region, const Point& y) { return Spectrum(planted.reflected(locator, region, y)); });
    std::array<double, 2> flux{}, area{};
    const ElementTree& tree = planted.delivered.tree;
    for (ElementId e : tree.leaves()) {
        const std::uint32_t body = bodies.of(planted.scene, tree.region(e));
        area[body] += tree.area(e);
        flux[body] += tree.area(e) * planted.rho * mean(planted.delivered.at({e, tree.centre(e)}));
    }
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CertificateOptions options{.error = 0.02, .seed = seed};
        options.bodies = &bodies;
        options.light_in = {1, 1}, options.allowed_in = {1, 1};
        Certifier certifier(planted.stage, planted.light, planted.delivered, b, options);
        Certificate found = certifier.measure();
        certifier.check_by_paths(found), certifier.measure_each_body(found);
        ASSERT_EQ(certifier.bodies().size(), 2u);
        // Thousands of places know the mean to about a percent; eight would miss it by a third and more.
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(certifier.bodies()[i].mean, flux[i] / area[i], 0.02 * flux[i] / area[i]);
    }
}

}  // namespace
}  // namespace exitance

#include "exitance/error/certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/error/body_errors.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// One or more separate furnaces with known exact indirect light, and a delivered function with a planted error, given
/// relative to the emitted light.
struct PlantedError {
    double rho = 0.5, exact = rho / (1 - rho);  // E_ind of M = 1
    Scene scene;
    Stage stage{scene};
    GlobalLight light;
    ElementFunction delivered;

    explicit PlantedError(const std::function<double(const Point&)>& error, double edge = 0.5,
                          Scene furnace = box_scene(2, 1, 1.5, 0.5, 1, 1), double reflectance = 0.5)
        : rho(reflectance), scene(std::move(furnace)) {
        stage.rooms = find_light_rooms(stage, 1, StopRequest());
        light.tree = stage.make_elements({.edge = edge, .grading_levels = 0});
        light.numbering = LeafNumbering(light.tree);
        for (ElementId e : light.numbering.leaves) {
            const double m = emitted(light.tree.region(e));
            light.direct.emplace_back(m);
            light.indirect.emplace_back(m * exact);
            light.reflected.emplace_back(m * rho * (1 + exact));
        }
        delivered.tree = light.tree;
        delivered.first_value.resize(light.tree.size(), 0);
        for (ElementId e : light.numbering.leaves) {
            delivered.first_value[e] = static_cast<std::uint32_t>(delivered.values.size());
            const Point middle = light.tree.patch(e).at(light.tree.centre(e));
            for (int i = 0; i < light.tree.patch(e).corner_count(); ++i)
                delivered.add_value(Spectrum(emitted(light.tree.region(e)) * (exact + error(middle))));
        }
    }

    /// Returns the exitance of a region, which is also the direct light on it.
    double emitted(RegionId region) const { return mean(scene.material(region).exitance); }
    double reflected(const ElementLocator& locator, RegionId region, const Point& y) const {
        return rho * (emitted(region) + mean(delivered.at(locator.find(region, y))));
    }

    /// Returns the certificate after this many calls of `measure`.
    Certificate certificate(std::uint64_t seed, int looks = 1, std::size_t points = 1280,
                            bool keeps_flux = false) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        Certifier certifier(stage, light, delivered, b,
                            {.error = 0.02, .seed = seed, .points = points, .keeps_flux = keeps_flux});
        for (int look = 1; look < looks; ++look) certifier.measure();
        return certifier.measure();
    }

    /// Returns a certificate that includes the 99th percentile.
    Certificate with_p99(std::uint64_t seed) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        Certifier certifier(stage, light, delivered, b, {.error = 0.02, .seed = seed, .points = 1280});
        Certificate out = certifier.measure();
        certifier.measure_p99(out);
        return out;
    }

    /// Returns the light of every room over the mean light.
    std::vector<double> light_by_room() const {
        std::vector<double> light_in(stage.rooms.count());
        const double mean_light = light.mean_reflected(stage.area);
        for (std::size_t i = 0; i < light.reflected.size(); ++i) {
            const ElementId e = light.numbering.leaves[i];
            const std::size_t room = stage.rooms.of(light.tree, e);
            light_in[room] += light.tree.area(e) * mean(light.reflected[i]) / (stage.rooms.area(room) * mean_light);
        }
        return light_in;
    }

    /// Returns the errors of the rooms, in descending order of area.
    std::vector<RoomError> rooms(std::uint64_t seed) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        const std::vector<double> light_in = light_by_room();
        Certifier certifier(
            stage, light, delivered, b,
            {.error = 0.02, .seed = seed, .keeps_flux = true, .light_in = light_in, .allowed_in = light_in});
        certifier.measure();
        return certifier.rooms();
    }

    /// Returns the certificate from sums over the elements, without rays.
    Certificate summed_certificate(std::uint64_t seed) const {
        ElementFunction reflected = delivered;
        for (std::array<float, bands>& value : reflected.values)
            for (float& v : value) v = static_cast<float>(rho * (1 + static_cast<double>(v)));
        const SummedLight summed{{ElementGather(stage, reflected)}, {}, 1e-3};
        const PointwiseLight unread([](RegionId, const Point&) { return Spectrum(); });
        return Certifier(stage, light, delivered, unread, {.error = 0.02, .seed = seed, .summed = &summed}).measure();
    }

    /// Returns the relative RMS of the planted error of B.
    double error(const std::function<double(const Point&)>& planted) const {
        double square = 0;
        for (ElementId e : light.numbering.leaves)
            square += light.tree.area(e) * std::pow(rho * planted(light.tree.patch(e).centre()), 2);
        return std::sqrt(square / stage.area) / (rho * (1 + exact));
    }
};

double rough(const Point& p) {
    return std::sin(40 * p.x) * std::cos(37 * p.y) * std::sin(43 * p.z + 1) > 0 ? 0.1 : -0.1;
}
double smooth(const Point&) {
    return 0.06;
}

TEST(Certificate, IsMoreAccurateAfterMorePoints) {
    const PlantedError planted(rough);
    const auto spread = [&](int looks) {
        constexpr std::uint64_t seeds = 16;
        double sum = 0, square = 0;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const Certificate c = planted.certificate(seed, looks);
            EXPECT_EQ(c.points, 1280u * static_cast<unsigned>(looks));
            sum += c.residual, square += c.residual * c.residual;
        }
        return std::sqrt((square - sum * sum / seeds) / (seeds - 1)) / (sum / seeds);
    };
    const double once = spread(1), four_times = spread(4);
    EXPECT_LT(once, 0.05);
    EXPECT_LT(four_times, 0.75 * once);  // expected: 0.5; sixteen seeds determine each spread to a sixth
}

TEST(Certificate, EndsFurtherMeasurementsAtAStop) {
    const PlantedError planted(rough);
    const ElementLocator locator(planted.delivered.tree, planted.scene.regions().size());
    const PointwiseLight b(
        [&](RegionId region, const Point& y) { return Spectrum(planted.reflected(locator, region, y)); });
    const SceneBodies bodies = find_bodies(planted.scene);
    StopRequest stop;
    Certifier certifier(planted.stage, planted.light, planted.delivered, b,
                        {.error = 0.02, .bodies = &bodies, .stop = &stop});
    stop.interrupt();
    const Certificate first = certifier.measure();
    EXPECT_EQ(first.points, 1280u);  // the first measurement is completed even after a stop request
    EXPECT_NEAR(first.residual, planted.error(rough), 0.2 * planted.error(rough));
    Certificate second = certifier.measure();
    EXPECT_EQ(second.points, 1280u);
    EXPECT_EQ(second.estimate, first.estimate);
    const std::size_t rays = second.rays;
    certifier.measure_p99(second);
    // The noise of few rays makes the percentile larger than the planted error, which is the same size everywhere.
    ASSERT_TRUE(second.p99);
    EXPECT_GT(*second.p99, first.residual);
    EXPECT_LT(second.rays, 2 * rays);
}

/// An error on one leaf in five hundred, chosen at random.
double rare(const Point& p) {
    const double chance = 43758.5453 * std::abs(std::sin(127.1 * p.x + 311.7 * p.y + 74.7 * p.z));
    return chance - std::floor(chance) < 0.002 ? 1 : 0;
}

TEST(Certificate, FindsErrorsOfFewElements) {
    const PlantedError planted(rare, 0.012);
    const std::size_t points = CertificateOptions::points_for(planted.light.numbering.leaves.size());
    ASSERT_GT(points, 5000u);
    const double truth = planted.error(rare);
    double square = 0;
    constexpr std::uint64_t seeds = 2;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        square += std::pow(planted.certificate(seed, 1, points).residual / truth - 1, 2) / seeds;
    // About twelve points hit an error, so that the relative error of its mean square is 1 / sqrt(12). Of 1280 points,
    // only two or three would hit one.
    EXPECT_LT(std::sqrt(square), 0.25);
}

/// A furnace whose projected direct light is wrong by a factor, and whose delivered light is consistent with it.
struct WrongProjection {
    static constexpr double factor = 1.2;
    PlantedError furnace{[](const Point&) { return factor - 1; }};  // E_ind = factor rho / (1 - rho), rho = 1/2
    ElementLocator locator{furnace.delivered.tree, furnace.scene.regions().size()};
    PointwiseLight projected{[](RegionId, const Point&) { return Spectrum(factor); }};
    PointwiseLight b{[this](RegionId region, const Point& y) {
        return Spectrum(furnace.rho * (factor + mean(furnace.delivered.at(locator.find(region, y)))));
    }};
    /// Relative to the mean reflected radiosity rho (1 + E_ind): E_ind = 1 has an error of 0.2.
    static constexpr double truth = (factor - 1) / 2;

    double estimate(std::uint64_t seed, const ProjectedDirect& told, const SummedLight* summed = nullptr) const {
        CertificateOptions options{.error = 0.02, .seed = seed};
        options.projected = told, options.summed = summed;
        return Certifier(furnace.stage, furnace.light, furnace.delivered, b, options).measure().estimate;
    }
};

TEST(Certificate, FindsAnErrorOfTheProjectionThatTheDeliveredLightShares) {
    const WrongProjection planted;
    const ProjectedDirect told{&planted.projected, Spectrum(1.0)};
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        EXPECT_LT(planted.estimate(seed, {}), 0.01);  // without the check, the estimate misses the error
        EXPECT_NEAR(planted.estimate(seed, told), planted.truth, 0.1 * planted.truth);
    }
    // If light is summed over elements, the light includes the projected light.
    ElementFunction reflected = planted.furnace.delivered;
    for (std::array<float, bands>& value : reflected.values)
        for (float& v : value) v = static_cast<float>(planted.furnace.rho * (planted.factor + static_cast<double>(v)));
    const SummedLight summed{{ElementGather(planted.furnace.stage, reflected)}, {}, 1e-3};
    EXPECT_LT(planted.estimate(1, {}, &summed), 0.01);
    EXPECT_NEAR(planted.estimate(1, told, &summed), planted.truth, 0.1 * planted.truth);
}

TEST(Certificate, FindsNoErrorInAnExactFurnace) {
    const PlantedError furnace([](const Point&) { return 0.0; });
    EXPECT_LT(furnace.certificate(1).bound, 1e-5);  // values are stored in single precision
    EXPECT_LT(furnace.summed_certificate(1).bound, 1e-5);
}

/// An error that is only in the elements next to two opposite edges of the floor.
double beside_edges(const Point& p) {
    const double from_wall = std::min(p.x, 2 - p.x);
    return (from_wall < 0.25 && p.z < 0.5) || (p.z < 0.25 && from_wall < 0.5) ? 0.1 : 0;
}

TEST(Certificate, IncludesInterreflectionBesideAnEdge) {
    const PlantedError planted(beside_edges, 0.2);
    const double truth = planted.error(beside_edges);
    double sum = 0;
    constexpr std::uint64_t seeds = 8;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) sum += planted.summed_certificate(seed).estimate / seeds;
    // The means of larger elements also include some of the error beside the edge.
    EXPECT_NEAR(sum, truth, 0.05 * truth);
}

/// An error that is positive in one half of a box and equally negative in the other, so that the absorbed light is
/// unchanged.
double balanced(const Point& p) {
    return (p.x < 1 ? 100 : -100) * rough({std::abs(p.x - 1), p.y, p.z});
}

TEST(Certificate, IsNotMisledByNoiseThatABrightRoomReflectsAHundredTimes) {
    const PlantedError planted(balanced, 0.125, box_scene(2, 1, 1.5, 0.99, 1, 1), 0.99);
    const double truth = planted.error(balanced);
    ASSERT_NEAR(truth, 0.1, 1e-3);
    double without = 0;
    constexpr std::uint64_t seeds = 6;
    constexpr std::size_t points = 320;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const double told = planted.certificate(seed, 1, points, true).estimate;
        EXPECT_LT(truth, 1.25 * told);
        EXPECT_LT(told, 1.25 * truth);
        without += std::abs(planted.certificate(seed, 1, points, false).estimate / truth - 1) / seeds;
    }
    EXPECT_GT(without, 0.25);  // otherwise the test would prove nothing
}

struct Planted {
    const char* name;
    double (*error)(const Point&);
};
class EveryError : public testing::TestWithParam<Planted> {};
INSTANTIATE_TEST_SUITE_P(Errors, EveryError, testing::Values(Planted{"rough", rough}, Planted{"smooth", smooth}),
                         [](const auto& info) { return info.param.name; });

TEST_P(EveryError, IsEstimatedAndBounded) {
    const PlantedError planted(GetParam().error);
    const double truth = planted.error(GetParam().error);
    ASSERT_GT(truth, 0.01);
    int within = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Certificate c = planted.certificate(seed);
        EXPECT_GE(c.bound, truth * (1 - 1e-6));  // values are stored in single precision
        within += truth <= 1.25 * c.estimate + 1e-3 && c.estimate <= 2 * truth + 1e-3;
        // Sums have no noise. The residual of the rough error includes its first reflection, which adds a twentieth.
        const Certificate summed = planted.summed_certificate(seed);
        EXPECT_GE(summed.bound, truth * (1 - 1e-6));
        EXPECT_NEAR(summed.estimate, truth, 0.07 * truth);
    }
    EXPECT_GE(within, 9);  // a measurement resolves a fifth of the requested error, so one of ten may miss
}

/// A furnace with a plate above its floor. The plate does not change the light, which is uniform in the gap as well.
Scene furnace_with_plate(double gap) {
    constexpr double rho = 0.5, side = 0.2;
    SceneDescription d;
    for (const double z : {0.0, 1.5}) d.points.insert(d.points.end(), {{0, 0, z}, {2, 0, z}, {2, 1, z}, {0, 1, z}});
    for (const double z : {gap, gap + 0.02})
        for (const auto& [x, y] : {Vec2{0.4, 0.4}, {0.4 + side, 0.4}, {0.4 + side, 0.4 + side}, {0.4, 0.4 + side}})
            d.points.push_back({x, y, z});
    d.materials = {{"wall", Spectrum(rho), Spectrum(1.0)}};
    d.groups = {"all"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::vector<std::uint32_t> face : box) {
        d.faces.push_back({face, 0, 0, 1});
        std::reverse(face.begin(), face.end());  // the plate's faces point outwards
        for (std::uint32_t& corner : face) corner += 8;
        d.faces.push_back({face, 0, 0, 2});
    }
    return std::move(*make_scene(std::move(d)).scene);
}

/// An error only in the gap, on both of its sides: 0.6% of the area.
double in_gap(const Point& p) {
    return p.z < 0.015 && p.x > 0.4 && p.x < 0.6 && p.y > 0.4 && p.y < 0.6 ? 0.5 : 0;
}

TEST(Certificate, FindsErrorsInAGapOfLittleArea) {
    const PlantedError planted(in_gap, 0.1, furnace_with_plate(0.01));
    const double truth = planted.error(in_gap);
    ASSERT_GT(truth, 0.015);
    double square = 0;
    constexpr std::uint64_t seeds = 8;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
        square += std::pow(planted.certificate(seed).residual / truth - 1, 2) / seeds;
    // Distributed by area, eight points would hit the error, and its square would be known to a third. Here, a fifth of
    // all points hits it. The remaining deviation is systematic: the two sides of the gap reflect their errors to each
    // other, so that the residual contains only half of the error.
    EXPECT_LT(std::sqrt(square), 0.56);
    double told = 0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) told += planted.certificate(seed).estimate / seeds;
    EXPECT_LT(truth, 1.25 * told);
    EXPECT_LT(told, 2 * truth);
}

TEST(Certificate, IgnoresDeliveredLightOnCoveredParts) {
    const PlantedError planted(in_gap, 0.1, furnace_with_plate(0));
    double square = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) square += std::pow(planted.certificate(seed).estimate, 2) / 4;
    ASSERT_GT(planted.error(in_gap), 0.01);
    EXPECT_LT(std::sqrt(square), 1e-5);  // values are stored in single precision
}

/// Two separate furnaces, one a hundredth as bright as the other.
Scene bright_and_dark_furnace() {
    SceneDescription d;
    d.materials = {{"bright", Spectrum(0.5), Spectrum(1.0)}, {"dark", Spectrum(0.5), Spectrum(0.01)}};
    d.groups = {"bright", "dark"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::uint32_t room = 0; room < 2; ++room) {
        const double x = 5 * room, size = 2 - 0.2 * room;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, 0, z}, {x + size, 0, z}, {x + size, size, z}, {x, size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * room;
            d.faces.push_back({face, room, room, 1});
        }
    }
    return std::move(*make_scene(std::move(d)).scene);
}

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

/// Two separate furnaces, the second with 1/64 of the first one's area, and a constant error only in the second.
TEST(Certificate, MeasuresSmallBodiesAtAdditionalPoints) {
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), Spectrum(1.0)}};
    d.groups = {"large", "small"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::uint32_t k = 0; k < 2; ++k) {
        const double x = 20 * k, size = k == 0 ? 16 : 2;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, 0, z}, {x + size, 0, z}, {x + size, size, z}, {x, size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * k;
            d.faces.push_back({face, 0, k, 1});
        }
    }
    PlantedError planted([](const Point& p) { return p.x > 18 ? 0.2 : 0.0; }, 1, std::move(*make_scene(d).scene));
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
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.5), Spectrum(1.0)}};
    d.groups = {"large", "small"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::uint32_t k = 0; k < 2; ++k) {
        const double x = 4 * k, size = k == 0 ? 2 : 0.25;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, 0, z}, {x + size, 0, z}, {x + size, size, z}, {x, size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * k;
            d.faces.push_back({face, 0, k, 1});
        }
    }
    PlantedError planted(rough, 0.5, std::move(*make_scene(d).scene));
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

TEST(Certificate, FindsThe99thPercentileWithoutNoise) {
    // The error is +0.1 on half of the elements and -0.1 on the others, so that its size is the same everywhere.
    const PlantedError planted(rough);
    const double everywhere = planted.error(rough);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Certificate told = planted.with_p99(seed);
        // The light that the rays read around a point varies by at most half of that.
        EXPECT_GT(told.p99, 0.95 * everywhere);
        EXPECT_LT(told.p99, 1.5 * everywhere);
    }
}

}  // namespace
}  // namespace exitance

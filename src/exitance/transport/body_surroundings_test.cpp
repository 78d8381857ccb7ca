#include "exitance/transport/body_surroundings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/scene/sky/sky_model.hpp"
#include "exitance/transport/light_rooms.hpp"
#include "support/motion.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// A house of 12 x 10 x 7 m on a square ground of `ground` m, under a uniform sky.
Scene house(double ground, const Motion& motion, bool with_sky = true) {
    SceneDescription d;
    d.groups = {"ground", "house"};
    d.materials = {{"grey", Spectrum(0.3), {}}};
    const auto add = [&](std::vector<Point> outline, std::uint32_t group) {
        SceneDescription::Face face;
        for (const Point& p : outline) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(motion(p));
        }
        face.group = group;
        d.faces.push_back(face);
    };
    const double g = ground / 2, x = 6, y = 5, z = 7;
    add({{-g, -g, 0}, {g, -g, 0}, {g, g, 0}, {-g, g, 0}}, 0);
    add({{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}, 1);
    add({{-x, -y, 0}, {x, -y, 0}, {x, -y, z}, {-x, -y, z}}, 1);
    add({{x, y, 0}, {-x, y, 0}, {-x, y, z}, {x, y, z}}, 1);
    add({{x, -y, 0}, {x, y, 0}, {x, y, z}, {x, -y, z}}, 1);
    add({{-x, y, 0}, {-x, -y, 0}, {-x, -y, z}, {-x, y, z}}, 1);
    if (with_sky) d.distant.domes.push_back({uniform_sky(), Spectrum(100.0)});
    return std::move(*make_scene(std::move(d)).scene);
}

SceneDescription description_of(const std::vector<test::Face>& faces) {
    SceneDescription d;
    d.groups = {"default"};
    d.materials = {{"grey", Spectrum(0.3), {}}};
    for (const test::Face& face : faces) {
        SceneDescription::Face f;
        for (const Point& p : face.corners) {
            f.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(p);
        }
        d.faces.push_back(f);
    }
    return d;
}

/// Another scale, turned about the vertical, and moved.
const Motion changed{0.03, {0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}, {7, -30, 11}};

LightRooms rooms_of(const Stage& stage) {
    return find_light_rooms(stage, 1, StopRequest());
}

TEST(BodySurroundings, OfAHouseOnALargeGroundAreARoom) {
    for (const Motion& motion : {as_written, changed})
        for (const double ground : {300.0, 3000.0}) {
            const Scene scene = house(ground, motion);
            const Stage stage(scene);
            const LightRooms rooms = rooms_of(stage);
            ASSERT_EQ(rooms.count(), 2u) << ground;
            const auto room_at = [&](double x) { return rooms.at(RegionId(0), motion({x, 0, 0})); };
            EXPECT_EQ(room_at(-100), 0u);
            EXPECT_EQ(room_at(-8), 1u);
            EXPECT_EQ(room_at(12), 1u);
            // The walls and the roof, and a circle of ground of about twice the radius of the house without its floor.
            const double radius = 2 * 0.5 * std::sqrt(12.0 * 12 + 10 * 10 + 7 * 7), outside = 12 * 10 + 2 * 22 * 7;
            const double expected = motion.scale * motion.scale * (outside + pi * radius * radius);
            EXPECT_NEAR(rooms.area(1), expected, 0.3 * expected) << ground;
        }
}

TEST(BodySurroundings, AreNoRoomIfTheyAreALargePartOfTheScene) {
    const Scene scene = house(40, as_written);
    EXPECT_EQ(rooms_of(Stage(scene)).count(), 0u);
    EXPECT_TRUE(BodySurroundings(Stage(scene)).are_empty());
}

TEST(BodySurroundings, ThingsInsideAHouseHaveNone) {
    // a closed hall of 60 x 60 x 40 m with a small box in it, whose outer faces see the sky
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {60, 60, 40});
    for (test::Face face : test::closed_box({-0.2, -0.2, -0.2}, {60.4, 60.4, 40.4})) {
        std::reverse(face.corners.begin(), face.corners.end());
        faces.push_back(face);
    }
    const std::size_t hall = faces.size();
    for (test::Face face : test::closed_box({57, 30, 1}, {2, 2, 2})) {
        std::reverse(face.corners.begin(), face.corners.end());
        faces.push_back(face);
    }
    for (const double height : {1.0, 50.0}) {  // in the hall, and above its roof
        for (std::size_t i = hall; i < faces.size(); ++i)
            for (Point& p : faces[i].corners) p.z += height - 1;
        SceneDescription d = description_of(faces);
        d.distant.domes.push_back({uniform_sky(), Spectrum(100.0)});
        const Scene scene = std::move(*make_scene(std::move(d)).scene);
        EXPECT_EQ(BodySurroundings(Stage(scene)).are_empty(), height < 40) << height;
    }
}

TEST(BodySurroundings, OfManyBodiesContainThePointsOfTheirBalls) {
    // 60 boxes of different sizes on a ground of 20 km
    std::vector<test::Face> faces{{{{-10000, -10000, 0}, {10000, -10000, 0}, {10000, 10000, 0}, {-10000, 10000, 0}}}};
    std::vector<Point> centres;
    std::vector<double> radii;
    for (int i = 0; i < 60; ++i) {
        const double size = 4 + i % 7, x = -8000 + 1600 * (i % 10), y = -6000 + 2000 * (i / 10);
        for (test::Face face : test::closed_box({x, y, 1}, {size, size, size})) {
            std::reverse(face.corners.begin(), face.corners.end());
            faces.push_back(face);
        }
        centres.push_back({x + 0.5 * size, y + 0.5 * size, 1 + 0.5 * size});
        radii.push_back(2 * std::sqrt(0.75) * size);
    }
    SceneDescription d = description_of(faces);
    d.distant.domes.push_back({uniform_sky(), Spectrum(100.0)});
    const Scene scene = std::move(*make_scene(std::move(d)).scene);
    const Stage stage(scene);
    const BodySurroundings surroundings(stage);
    EXPECT_EQ(surroundings.bodies().size(), 60u);
    for (std::size_t i = 0; i < centres.size(); ++i)
        for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0.6, 0.8, 0}, Vec3{0, 0, -1}}) {
            EXPECT_TRUE(surroundings.contain(centres[i] + (1 - 1e-9) * radii[i] * way)) << i;
            EXPECT_FALSE(surroundings.contain(centres[i] + (1 + 1e-9) * radii[i] * way)) << i;
        }
    // A stop ends the refinement of elements.
    StopRequest stop;
    ElementTree stopped = stage.make_elements({20000, 0}, nullptr), refined = stopped;
    const std::size_t before = stopped.size();
    stop.interrupt();
    surroundings.refine(stopped, &stop);
    EXPECT_EQ(stopped.size(), before);
    surroundings.refine(refined, nullptr);
    EXPECT_GT(refined.size(), before);
}

TEST(BodySurroundings, AreNoRoomWithoutASky) {
    const Scene scene = house(3000, as_written, false);
    EXPECT_TRUE(BodySurroundings(Stage(scene)).are_empty());
}

}  // namespace
}  // namespace exitance

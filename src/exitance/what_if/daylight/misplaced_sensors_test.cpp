#include "exitance/what_if/daylight/misplaced_sensors.hpp"

#include <gtest/gtest.h>

#include "support/checked_scene.hpp"

namespace exitance {
namespace {

/// A room of 4 x 3 x 2.5 m whose faces have their fronts inside, with an open window in the south, and a ground of
/// 40 x 40 m around it. `roof`: with its ceiling, else open.
Stage room(bool roof) {
    SceneDescription d;
    d.file = "room.obj", d.groups = {"all"}, d.materials = {{"grey", Spectrum(0.5), {}}};
    const auto add = [&](const std::vector<Point>& corners) { add_polygon(d, corners); };
    add({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
    if (roof) add({{0, 0, 2.5}, {0, 3, 2.5}, {4, 3, 2.5}, {4, 0, 2.5}});
    add({{0, 3, 0}, {4, 3, 0}, {4, 3, 2.5}, {0, 3, 2.5}}), add({{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}});
    add({{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}}), add({{0, 0, 0}, {0, 0, 1}, {4, 0, 1}, {4, 0, 0}});
    add({{-20, -20, -0.3}, {20, -20, -0.3}, {20, 20, -0.3}, {-20, 20, -0.3}});
    static std::vector<std::unique_ptr<Scene>> scenes;  // a stage refers to its scene
    scenes.push_back(std::make_unique<Scene>(checked_scene(std::move(d))));
    return Stage(*scenes.back());
}

std::vector<SurfacePoint> upwards(const std::vector<Point>& points) {
    std::vector<SurfacePoint> out;
    for (const Point& p : points) out.push_back({p, {0, 0, 1}, {}});
    return out;
}

}  // namespace

TEST(MisplacedSensors, AreOutdoorsOrBehindFaces) {
    const Stage stage = room(true);
    const std::vector<SurfacePoint> sensors =
        upwards({{2, 1.5, 0.8}, {2, 0.1, 0.8}, {-3, 1.5, 0.8}, {2, 1.5, -0.1}, {2, -0.5, 0.8}, {2, 1.5, 2.4}});
    const MisplacedSensors found = find_misplaced(stage, sensors);
    EXPECT_EQ(found.outdoors, (std::vector<std::size_t>{2, 4}));
    EXPECT_EQ(found.behind, std::vector<std::size_t>{3});
    const std::vector<std::string> warnings = warnings_of(found, sensors);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(
        warnings[0],
        "2 of 6 sensors lie outdoors, below the open sky, but count like the others; the first is sensor 2 (counted "
        "from 0) at -3, 1.5, 0.8");
    EXPECT_EQ(warnings[1],
              "1 of 6 sensors sees mostly backs of faces, as below a floor or inside of a body; the first is sensor 3 "
              "(counted from 0) at 2, 1.5, -0.1");
}

TEST(MisplacedSensors, AreNoneIfAllAreOutdoorsOrIndoors) {
    const Stage open = room(false), closed = room(true);
    const std::vector<SurfacePoint> sensors = upwards({{2, 1.5, 0.8}, {-3, 1.5, 0.8}});
    EXPECT_TRUE(find_misplaced(open, sensors).outdoors.empty());
    EXPECT_TRUE(find_misplaced(closed, std::span(sensors).first(1)).outdoors.empty());
    EXPECT_TRUE(warnings_of({}, sensors).empty());
}

}  // namespace exitance

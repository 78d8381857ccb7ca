#include "exitance/visibility/thin_walls.hpp"

#include <gtest/gtest.h>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/transport/stage.hpp"
#include "support/solved.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

/// A room of 4 x 3 x 2.5 m, with a smaller room on top of its ceiling, or a box on its floor.
std::vector<Face> room_and(bool upper_room, double exitance) {
    std::vector<Face> faces = test::closed_box({0, 0, 0}, {4, 3, 2.5});
    for (Face face : test::closed_box({1, 1, upper_room ? 2.5 : 0.0}, {2, 1, 1})) {
        if (!upper_room) std::reverse(face.corners.begin(), face.corners.end());
        faces.push_back(face);
    }
    for (Face& face : faces) face.exitance = exitance;
    return faces;
}

Scene placed(std::vector<Face> faces, const Frame& frame, const Vec3& shift, double scale) {
    for (Face& face : faces)
        for (Point& p : face.corners) p = Point{} + scale * (shift + frame.to_world(p.x, p.y, p.z));
    return test::make(faces);
}

TEST(ThinWalls, AreBetweenRoomsAndNotBelowABoxOnAFloor) {
    for (const Normal& up : {Normal{0, 0, 1}, normalized(Vec3{0.3, -0.5, 0.7})})
        for (const double scale : {1e-3, 1.0, 1e3}) {
            const Frame frame(up);
            const Vec3 shift{70, -30, 20};
            const auto is_covered = [&](bool upper_room, const Point& at, const Normal& n, std::size_t face) {
                const Scene scene = placed(room_and(upper_room, 1), frame, shift, scale);
                const Stage stage(scene);
                return stage.occluders.is_covered(Point{} + scale * (shift + frame.to_world(at.x, at.y, at.z)),
                                                  frame.to_world(n.x, n.y, n.z),
                                                  scene.surfaces()[SurfaceId(face)].region);
            };
            EXPECT_FALSE(is_covered(true, {2, 1.5, 2.5}, {0, 0, -1}, 1)) << "ceiling below the upper room";
            EXPECT_FALSE(is_covered(true, {2, 1.5, 2.5}, {0, 0, 1}, 6)) << "floor of the upper room";
            EXPECT_TRUE(is_covered(false, {2, 1.5, 0}, {0, 0, 1}, 0)) << "floor below the box";
            EXPECT_TRUE(is_covered(false, {2, 1.5, 0}, {0, 0, -1}, 6)) << "bottom of the box";
            EXPECT_FALSE(is_covered(false, {0.5, 1.5, 0}, {0, 0, 1}, 0)) << "floor beside the box";
        }
}

// Each room is a furnace, in which E = M / (1 - rho) on all surfaces.
TEST(ThinWalls, HaveTheLightOfTheirOwnSide) {
    const Scene scene = test::make(room_and(true, 1));
    const Solution solution = solved(scene, {.error = 0.02});
    const RadiosityFunction light(solution);
    const std::vector<ProbePoint> points = {{{2, 1.5, 2.5}, {0, 0, -1}},
                                            {{2, 1.5, 2.5}, {0, 0, 1}},
                                            {{0.5, 1.5, 2.5}, {0, 0, -1}},
                                            {{1.2, 1.8, 2.5}, {0, 0, 1}}};
    for (const Light& l : light.at(points)) EXPECT_NEAR(l.irradiance[0], 2, 0.02 * 2);
}

}  // namespace
}  // namespace exitance

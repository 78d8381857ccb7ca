#include "exitance/visibility/tracing_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

/// Square bars along one axis in a room, rotated into a frame.
std::vector<test::Face> bars_in_room(const Frame& frame, const Point& apex) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {6, 4, 3});
    for (int bar = 0; bar < 12; ++bar) {
        const double y = 0.5 + 0.25 * bar, z = 1 + 0.1 * bar, wide = 0.1;
        const Point a{0.5, y, z}, b{0.5, y + wide, z}, c{0.5, y + wide, z + wide}, d{0.5, y, z + wide};
        const Vec3 along{5, 0, 0};
        faces.push_back({{b, a, a + along, b + along}});
        faces.push_back({{c, b, b + along, c + along}});
        faces.push_back({{d, c, c + along, d + along}});
        faces.push_back({{a, d, d + along, a + along}});
    }
    for (test::Face& face : faces)
        for (Point& p : face.corners) p = apex + frame.to_world(p.x, p.y, p.z);
    return faces;
}

bool is_parallel_to_an_axis(const TracingFrame& frame, const Normal& n) {
    const Vec3 turned = frame(n);
    return std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)}) > 1 - 1e-9;
}

TEST(TracingFrame, IsThatOfMostFaces) {
    for (const Normal& n : {normalized(Vec3{0.3, -0.5, 0.7}), normalized(Vec3{0.9, 0.1, -0.4})}) {
        const Frame axes(n);
        const TracingFrame frame = find_tracing_frame(test::make(bars_in_room(axes, {61, -53, 59})));
        ASSERT_TRUE(frame.is_turned);
        for (const Normal& axis : {axes.u, axes.v, axes.n}) EXPECT_TRUE(is_parallel_to_an_axis(frame, axis));
        EXPECT_NEAR(dot(cross(frame.x, frame.y), frame.z), 1, 1e-12);
    }
}

TEST(TracingFrame, IsThatOfTheSceneIfMostFacesAreParallelToItsAxes) {
    EXPECT_FALSE(find_tracing_frame(test::make(bars_in_room(Frame({0, 0, 1}), {}))).is_turned);
    EXPECT_FALSE(find_tracing_frame(test::make(bars_in_room(Frame({0, 1, 0}), {5, 6, 7}))).is_turned);
}

}  // namespace
}  // namespace exitance

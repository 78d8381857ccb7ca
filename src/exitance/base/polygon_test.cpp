#include "exitance/base/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

/// Rotates about two axes, then moves.
Point placed(const Point& p, double angle, const Vec3& offset) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec3 q = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    return Point(Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z} + offset);
}

/// Two new corners in place of one whose distance from the plane is due to rounding would be ends of an edge with an
/// arbitrary direction.
TEST(Clip, ACornerInThePlaneByRoundingStaysOneCorner) {
    const std::vector<Point> whole = {{0, 0, 0}, {2, -1, 1}, {2, 1, 3}};
    const std::vector<Point> base = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (const double far : {0.0, 1e3, 1e6})
        for (int k = 0; k < 200; ++k) {
            std::vector<Point> triangle, square, part;
            for (const Point& p : whole) triangle.push_back(placed(p, 0.1 * k, {far, -far, 0.5 * far}));
            for (const Point& p : base) square.push_back(placed(p, 0.1 * k, {far, -far, 0.5 * far}));
            const Normal n = normalized(area_vector(square));
            clip(triangle, {n, dot(n, square[0])}, part);
            EXPECT_EQ(part.size(), 3u) << far << ' ' << k;
            clip(triangle, {-n, -dot(n, square[0])}, part);  // only the shared corner is on this side
            EXPECT_TRUE(part.empty()) << far << ' ' << k;
        }
}

TEST(Clip, APlaneThroughTheMiddleHalvesASquare) {
    const std::vector<Point> square = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    std::vector<Point> part;
    clip(square, {{1, 0, 0}, 0}, part);
    ASSERT_EQ(part.size(), 4u);
    EXPECT_EQ(norm(area_vector(part)), 2);
    clip(square, {{1, 0, 0}, 2}, part);
    EXPECT_TRUE(part.empty());
}

}  // namespace
}  // namespace exitance

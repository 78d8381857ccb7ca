#include "exitance/form_factors/point_to_polygon.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Form factor of an X x Y rectangle, parallel at distance 1, from the point below one of its corners.
double corner_rectangle(double X, double Y) {
    const double p = std::sqrt(1 + X * X), q = std::sqrt(1 + Y * Y);
    return (X / p * std::atan(Y / p) + Y / q * std::atan(X / q)) / (2 * pi);
}

std::vector<Point> ceiling(double x0, double y0, double x1, double y1, double z) {
    return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

TEST(PointToPolygon, MeetsTheClosedFormForRectanglesOfEverySize) {
    for (double size : {3.0, 1.0, 0.1, 0.05, 0.03, 0.01, 1e-3, 1e-5, 1e-8}) {
        const double f = point_to_polygon({0, 0, 0}, {0, 0, 1}, ceiling(0, 0, size, 2 * size, 1));
        const double exact = corner_rectangle(size, 2 * size);
        EXPECT_NEAR(f / exact, 1, 1e-13) << size;  // a few rounding errors
    }
}

TEST(PointToPolygon, KeepsItsDigitsAtGrazingIncidence) {
    const double f =
        point_to_polygon({0, 0, 0}, {0, 0, 1}, {{{100, 0, 0.5}, {100, 1, 0.5}, {101, 1, 0.5}, {101, 0, 0.5}}});
    EXPECT_NEAR(f / 7.80030446449299e-10, 1, 1e-12);  // Lambert's sum at 30 digits; printed with 15
}

TEST(PointToPolygon, CountsOnlyThePartAboveTheHorizon) {
    const std::vector<Point> wall = {{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}};
    const std::vector<Point> upper = {{1, -1, 0}, {1, -1, 1}, {1, 1, 1}, {1, 1, 0}};
    const double f = point_to_polygon({0, 0, 0}, {0, 0, 1}, wall);
    EXPECT_NEAR(f, point_to_polygon({0, 0, 0}, {0, 0, 1}, upper), 1e-16);
    EXPECT_GT(f, 0.05);
    EXPECT_EQ(point_to_polygon({0, 0, 2}, {0, 0, 1}, wall), 0);
}

TEST(PointToPolygon, IsZeroBehindTheSourceAndInItsPlane) {
    const std::vector<Point> source = ceiling(0, 0, 1, 1, 1);
    EXPECT_EQ(point_to_polygon({0.5, 0.5, 2}, {0, 0, -1}, source), 0);
    EXPECT_EQ(point_to_polygon({3, 0.5, 1}, {-1, 0, 0}, source), 0);
    EXPECT_EQ(point_to_polygon({0.5, 0.5, 0}, {0, 0, -1}, source), 0);
}

TEST(PointToPolygon, WallsAndCeilingOfAClosedRoomSumToOne) {
    const Point x{0.3, 0.7, 0};
    const Normal up{0, 0, 1};
    double sum = point_to_polygon(x, up, ceiling(0, 0, 1, 2, 1.5));
    const std::array<Point, 4> foot = {{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}};
    for (int i = 0; i < 4; ++i) {
        const Point &a = foot[i], &b = foot[(i + 1) % 4];
        const Vec3 rise{0, 0, 1.5};
        sum += point_to_polygon(x, up, std::vector<Point>{b, a, a + rise, b + rise});
    }
    EXPECT_NEAR(sum, 1, 1e-14);
}

TEST(PointToPolygon, IsAdditiveUnderCutsForAnyHorizon) {
    RandomStream random(7, Stream::mesh);
    for (int i = 0; i < 500; ++i) {
        const auto any = [&] { return Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5}; };
        const Normal n = normalized(any());
        const double size = std::pow(10.0, -6 * random.uniform());
        const Point o = any(), a = o + size * any(), b = o + size * any(), c = o + size * any();
        const double t = random.uniform();
        const Point cut = a + t * (b - a);
        const double whole = point_to_polygon({}, n, {{a, b, c}});
        const double parts = point_to_polygon({}, n, {{a, cut, c}}) + point_to_polygon({}, n, {{cut, b, c}});
        EXPECT_NEAR(whole, parts, 1e-13 * std::min(1.0, size * size) + 1e-15 * size) << size;
    }
}

TEST(PointToPolygon, IsExactForConcaveSourcesInAnyPosition) {
    const std::vector<Point> ell = {{0, 0, 2}, {0, 3, 2}, {0.5, 3, 2}, {0.5, 0.5, 2}, {3, 0.5, 2}, {3, 0, 2}};
    const Normal tilted = normalized(Vec3{0.9, -0.5, 0.05});
    for (const Normal& n : {Normal{0, 0, 1}, tilted}) {
        const double f = point_to_polygon({1, 1, 0}, n, ell);
        const double parts = point_to_polygon({1, 1, 0}, n, ceiling(0, 0, 0.5, 3, 2)) +
                             point_to_polygon({1, 1, 0}, n, ceiling(0.5, 0, 3, 0.5, 2));
        EXPECT_NEAR(f, parts, 1e-15);
    }
}

}  // namespace
}  // namespace exitance

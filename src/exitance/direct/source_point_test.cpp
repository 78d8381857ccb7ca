#include "exitance/direct/source_point.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t count = 1 << 14;
const std::vector<Point> lamp{{1, 1, 3}, {1, 3, 3}, {4, 3, 3}, {4, 1, 3}};  // faces down, 3 x 2 m
const Normal down{0, 0, -1};

/// Share of the lamp's light at a point that comes from the part of the lamp with x below `to`, by sampling.
double share_below(const Point& x, const Normal& n, double to) {
    const SeenPolygon seen(lamp, down, 6, x);
    const ScrambledSobol numbers(7);
    double part = 0, all = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Point y = seen.at(numbers(i, 0), numbers(i, 1));
        EXPECT_NEAR(y.z, 3, 1e-9);
        EXPECT_TRUE(y.x > 1 - 1e-9 && y.x < 4 + 1e-9 && y.y > 1 - 1e-9 && y.y < 3 + 1e-9);
        const double weight = seen.weight(y - x, n);
        all += weight, part += y.x < to ? weight : 0;
    }
    return part / all;
}

TEST(SeenPolygon, PointsHaveTheLightOfTheirParts) {
    const struct {
        Point x;
        Normal n;
    } receivers[] = {{{2.5, 2, 2.85}, {0, 0, 1}},
                     {{1.2, 1.1, 2.9}, {1, 0, 0}},
                     {{2, 0.5, 2.95}, normalized(Vec3{0, 1, 0.2})},
                     {{2.5, 2, 0}, {0, 0, 1}}};
    for (const auto& [x, n] : receivers) {
        std::vector<Point> part = lamp;
        for (Point& p : part) p.x = std::min(p.x, 2.0);
        const double exact = point_to_polygon(x, n, part) / point_to_polygon(x, n, lamp);
        // With 16,384 evenly spread points the error is within a third of a percent; with independent ones it would be
        // one percent.
        EXPECT_NEAR(share_below(x, n, 2), exact, 0.0033) << x.x << " " << x.z;
    }
}

TEST(SeenPolygon, PointsFollowTheSolidAngleOfANearLamp) {
    const Point x{2.5, 2, 2.85};
    const SeenPolygon seen(lamp, down, 6, x);
    const ScrambledSobol numbers(7);
    int near = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 d = seen.at(numbers(i, 0), numbers(i, 1)) - x;
        near += std::hypot(d.x, d.y) < 0.15;
    }
    // A cone of 45 degrees has 1 - cos 45 = 0.293 of the half space; the lamp does not reach the whole horizon.
    EXPECT_GT(near, 0.293 * count);
    EXPECT_LT(near, 0.36 * count);
}

TEST(SeenPolygon, FewPointsOfADiscFindHowMuchOfItIsHidden) {
    std::vector<Point> disc;
    constexpr int corners = 48;
    for (int i = 0; i < corners; ++i)
        disc.push_back({std::cos(2 * pi * i / corners), -std::sin(2 * pi * i / corners), 100});
    const double area = norm(area_vector(disc));
    const SeenPolygon seen(disc, down, area, {});
    constexpr std::uint32_t rays = 256, cuts = 64;
    double squares = 0;
    for (std::uint32_t k = 0; k < cuts; ++k) {
        const ScrambledSobol numbers(k);
        const double angle = k, edge = -0.8 + 1.6 * k / cuts;
        double found = 0;
        for (std::uint32_t i = 0; i < rays; ++i) {
            const Point y = seen.at(numbers(i, 0), numbers(i, 1));
            EXPECT_LE(std::hypot(y.x, y.y), 1 + 1e-9);
            found += std::cos(angle) * y.x + std::sin(angle) * y.y > edge ? 1.0 / rays : 0;
        }
        squares += std::pow(found - (std::acos(edge) - edge * std::sqrt(1 - edge * edge)) / pi, 2);
    }
    // The law of stratified samples, 0.5 n^(-3/4): 0.0078. If each triangle is sampled by itself, the error is 0.012.
    EXPECT_LT(std::sqrt(squares / cuts), 0.0078);
}

}  // namespace
}  // namespace exitance

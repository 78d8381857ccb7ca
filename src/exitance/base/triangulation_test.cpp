#include "exitance/base/triangulation.hpp"

#include <gtest/gtest.h>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"

namespace exitance {
namespace {

template <class Pieces>
double total_area(std::span<const Point> outline, const Normal& n, const Pieces& pieces) {
    double sum = 0;
    for (const auto& piece : pieces) {
        std::vector<Point> corners;
        for (std::uint32_t i : piece) corners.push_back(outline[i]);
        EXPECT_TRUE(is_convex(corners, n, 1e-12));
        EXPECT_GT(dot(area_vector(corners), n), 0);
        sum += norm(area_vector(corners));
    }
    return sum;
}

void expect_covered(std::span<const Point> outline) {
    const Vec3 whole = area_vector(outline);
    const Normal n = normalized(whole);
    EXPECT_NEAR(total_area(outline, n, triangulate(outline, n)), norm(whole), 1e-12 * norm(whole));
    EXPECT_NEAR(total_area(outline, n, convex_pieces(outline, n)), norm(whole), 1e-12 * norm(whole));
}

TEST(Triangulation, CoversRandomStarsOnce) {
    RandomStream random(3, Stream::mesh);
    for (int trial = 0; trial < 60; ++trial) {
        const Frame frame(normalized({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5}));
        std::vector<Point> star;
        const int corners = 3 + trial;
        for (int i = 0; i < corners; ++i) {
            const double angle = 2 * pi * (i + 0.8 * random.uniform()) / corners, r = 0.2 + random.uniform();
            star.push_back(Point{1, 2, 3} + frame.to_world(r * std::cos(angle), r * std::sin(angle), 0));
        }
        if (dot(area_vector(star), frame.n) > 0) expect_covered(star);
    }
}

TEST(Triangulation, CoversWallsWithDoorsAndBridgedHolesOnce) {
    expect_covered(
        std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {2, 0, 2}, {2, 0, 0}, {5, 0, 0}, {5, 0, 3}, {0, 0, 3}});
    // a window joined to the border by a bridge traversed in both directions
    expect_covered(std::vector<Point>{
        {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}});
}

TEST(Triangulation, KeepsConvexOutlinesWholeAndSplitsAnEllInTwo) {
    const std::vector<Point> square = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(convex_pieces(square, {0, 0, 1}).size(), 1u);
    const std::vector<Point> ell = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    EXPECT_EQ(convex_pieces(ell, {0, 0, 1}).size(), 2u);
}

}  // namespace
}  // namespace exitance

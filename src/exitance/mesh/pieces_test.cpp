#include "exitance/mesh/pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace exitance {
namespace {

using Loop = std::vector<Point>;
const Normal up{0, 0, 1};

double area(const std::vector<Patch>& patches) {
    double sum = 0;
    for (const Patch& p : patches) sum += p.area();
    return sum;
}

std::size_t triangles(const std::vector<Patch>& patches) {
    return static_cast<std::size_t>(
        std::count_if(patches.begin(), patches.end(), [](const Patch& p) { return p.is_triangle(); }));
}

/// Height over longest side (twice that for triangles): 1 for a square.
double worst_shape(const std::vector<Patch>& patches) {
    double worst = 1;
    for (const Patch& p : patches) {
        const double longest =
            std::max({squared_norm(p.a), squared_norm(p.b), p.is_triangle() ? squared_norm(p.a - p.b) : 0.0});
        worst = std::min(worst, norm(cross(p.a, p.b)) / longest);
    }
    return worst;
}

std::vector<Patch> tile_one(Loop loop) {
    return tile(std::vector<Loop>{std::move(loop)}, up);
}

TEST(Pieces, AParallelogramAndATriangleAreOnePieceEach) {
    const auto parallelogram = tile_one({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}});
    ASSERT_EQ(parallelogram.size(), 1u);
    EXPECT_EQ(parallelogram[0].normal(), up);
    EXPECT_EQ(parallelogram[0].corner(2), (Point{3, 1, 0}));
    const auto triangle = tile_one({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}});
    ASSERT_EQ(triangle.size(), 1u);
    EXPECT_EQ(triangles(triangle), 1u);
}

TEST(Pieces, AWallWithADoorIsThreeRectanglesCutOnTheShortSide) {
    const auto wall = tile_one(
        {{0, 0, 0}, {0.45, 0, 0}, {0.45, 2.1, 0}, {1.35, 2.1, 0}, {1.35, 0, 0}, {4, 0, 0}, {4, 2.8, 0}, {0, 2.8, 0}});
    ASSERT_EQ(wall.size(), 3u);
    EXPECT_EQ(triangles(wall), 0u);
    EXPECT_NEAR(area(wall), 4 * 2.8 - 0.9 * 2.1, 1e-12 * 9.31);
    EXPECT_GT(worst_shape(wall), 0.15);  // 0.45 by 2.8; a cut at the lintel would give a strip of 4 by 0.7
}

TEST(Pieces, AFrameIsFourRectanglesAndAnEmptyOneNothing) {
    const std::vector<Loop> frame = {{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}},
                                     {{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}};
    const auto pieces = tile(frame, up);
    EXPECT_EQ(pieces.size(), 4u);
    EXPECT_EQ(triangles(pieces), 0u);
    EXPECT_DOUBLE_EQ(area(pieces), 8);
}

TEST(Pieces, ATrapezoidIsAParallelogramAndATriangleUnlessThatIsASliver) {
    const auto wide = tile_one({{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {0.5, 1, 0}});
    ASSERT_EQ(wide.size(), 2u);
    EXPECT_EQ(triangles(wide), 1u);
    EXPECT_DOUBLE_EQ(area(wide), 2.25);
    const auto nearly_square = tile_one({{0, 0, 0}, {1, 0, 0}, {0.97, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(triangles(nearly_square), 2u);
    EXPECT_GT(worst_shape(nearly_square), 0.4);
}

TEST(Pieces, ATurnedAndLiftedLShapeIsStillTwoRectangles) {
    const Frame frame(normalized(Vec3{1, 2, 3}));
    Loop loop;
    for (const Point& p : Loop{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}})
        loop.push_back(Point{5, -2, 7} + frame.to_world(p.x * 0.8 - p.y * 0.6, p.x * 0.6 + p.y * 0.8, 0));
    const auto pieces = tile(std::vector<Loop>{loop}, frame.n);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(triangles(pieces), 0u);
    EXPECT_NEAR(area(pieces), 4, 4e-12);
    for (const Patch& p : pieces) EXPECT_NEAR(dot(p.normal(), frame.n), 1, 1e-12);
}

TEST(Pieces, AConcavePolygonIsTriangulatedWithinItsBorder) {
    const auto arrow = tile_one({{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}});
    ASSERT_EQ(arrow.size(), 2u);
    EXPECT_NEAR(area(arrow), 1, 1e-12);
    for (const Patch& p : arrow) EXPECT_LT(p.centre().x, 1.1);
}

TEST(Pieces, AGableKeepsItsRectangle) {
    const auto gable = tile_one({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 3, 0}, {0, 2, 0}});
    ASSERT_EQ(gable.size(), 2u);
    EXPECT_EQ(triangles(gable), 1u);
    EXPECT_NEAR(area(gable), 10, 1e-11);
}

TEST(Pieces, ACombWithManyTeethIsRectanglesOnly) {
    Loop comb{{0, -1, 0}, {80, -1, 0}};
    for (int i = 40; i-- > 0;) {
        comb.push_back({2.0 * i + 2, 1, 0});
        comb.push_back({2.0 * i + 1, 1, 0});
        comb.push_back({2.0 * i + 1, 0, 0});
        comb.push_back({2.0 * i, 0, 0});
    }
    const auto pieces = tile_one(comb);
    EXPECT_EQ(triangles(pieces), 0u);
    EXPECT_LE(pieces.size(), 41u + 10);  // divided into blocks first: one piece per tooth and per block's back
    EXPECT_GT(worst_shape(pieces), 0.05);
    EXPECT_NEAR(area(pieces), 80 + 40, 1e-10);
}

}  // namespace
}  // namespace exitance

#include "exitance/view_factors/convex_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double rounding_of_drawings = 1e-8;

/// The plane of a test: a point (x, y) of the drawing is at origin + x u + y v.
struct Drawing {
    Point origin;
    Vec3 u, v;
    Normal normal() const { return normalized(cross(u, v)); }
    double scale() const { return norm(cross(u, v)); }
    std::vector<Point> rectangle(Vec2 a, Vec2 b) const {
        return {at({a.x, a.y}), at({b.x, a.y}), at({b.x, b.y}), at({a.x, b.y})};
    }

  private:
    Point at(Vec2 p) const { return origin + p.x * u + p.y * v; }
};

/// Along the axes, turned and moved, and small.
const std::vector<Drawing>& drawings() {
    static const std::vector<Drawing> all = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                             {{5, -3, 2}, {0.8, 0.6, 0}, {-0.48, 0.64, 0.6}},
                                             {{0, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}}};
    return all;
}

double total_area(const ConvexParts& parts) {
    double sum = 0;
    for (const std::vector<Point>& part : parts) sum += norm(area_vector(part));
    return sum;
}

ConvexParts rest_of(const std::vector<Point>& polygon, const ConvexParts& holes, const Normal& n) {
    const std::vector<std::span<const Point>> spans(holes.begin(), holes.end());
    ConvexParts parts;
    subtract(polygon, spans, n, rounding_of_drawings, parts);
    return parts;
}

TEST(ConvexParts, ManyHolesLeaveTheAreaBetweenThem) {
    for (const Drawing& drawing : drawings()) {
        constexpr int side = 12;  // a grid of side x side holes, each a quarter of its cell
        ConvexParts holes;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
                holes.push_back(
                    drawing.rectangle({(i + 0.25) / side, (j + 0.25) / side}, {(i + 0.75) / side, (j + 0.75) / side}));
        const ConvexParts parts = rest_of(drawing.rectangle({0, 0}, {1, 1}), holes, drawing.normal());
        EXPECT_NEAR(total_area(parts), 0.75 * drawing.scale(), 1e-9 * drawing.scale());
        EXPECT_LE(parts.size(), 6 * holes.size());
        for (const std::vector<Point>& part : parts)
            for (const std::vector<Point>& hole : holes)
                EXPECT_TRUE(is_negligible(intersection(part, hole, drawing.normal()), rounding_of_drawings));
    }
}

TEST(ConvexParts, HolesThatOverlapCountOnce) {
    for (const Drawing& drawing : drawings()) {
        const ConvexParts holes = {drawing.rectangle({0.1, 0.1}, {0.5, 0.5}), drawing.rectangle({0.3, 0.3}, {0.7, 0.7}),
                                   drawing.rectangle({0.3, 0.3}, {0.7, 0.7})};
        const ConvexParts parts = rest_of(drawing.rectangle({0, 0}, {1, 1}), holes, drawing.normal());
        EXPECT_NEAR(total_area(parts), (1 - 0.28) * drawing.scale(), 1e-9 * drawing.scale());
    }
}

TEST(ConvexParts, HolesThatOnlyTouchLeaveThePolygonAsItIs) {
    for (const Drawing& drawing : drawings()) {
        const std::vector<Point> polygon = drawing.rectangle({0, 0}, {1, 1});
        const ConvexParts holes = {drawing.rectangle({1, 0}, {2, 1}), drawing.rectangle({-1, -1}, {0, 0})};
        EXPECT_EQ(rest_of(polygon, holes, drawing.normal()), ConvexParts{polygon});
    }
}

TEST(ConvexParts, AHoleThatCoversThePolygonLeavesNothing) {
    for (const Drawing& drawing : drawings())
        EXPECT_TRUE(rest_of(drawing.rectangle({0, 0}, {1, 1}), {drawing.rectangle({-1, -1}, {1, 1})}, drawing.normal())
                        .empty());
}

TEST(ConvexParts, LongOutlinesAreDividedIntoPartsOfTwelveCorners) {
    std::vector<Point> circle;
    for (int k = 0; k < 100; ++k) circle.push_back({std::cos(0.02 * pi * k), std::sin(0.02 * pi * k), 0});
    ConvexParts parts;
    add_parts(circle, parts);
    EXPECT_NEAR(total_area(parts), norm(area_vector(circle)), 1e-12);
    EXPECT_TRUE(std::all_of(parts.begin(), parts.end(), [](const auto& part) { return part.size() <= 12; }));
}

}  // namespace
}  // namespace exitance

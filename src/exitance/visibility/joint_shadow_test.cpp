#include "exitance/visibility/joint_shadow.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

ConvexBlocker sheet_at(double x, double from, double to) {
    const std::vector<Point> outline = {{x, from, -1}, {x, to, -1}, {x, to, 2}, {x, from, 2}};
    return make_sheet(outline, {{1, 0, 0}, x});
}

/// Two unit squares 10 m apart, facing each other along x.
const std::vector<Point> near_square = {{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
const std::vector<Point> far_square = {{10, 0, 0}, {10, 0, 1}, {10, 1, 1}, {10, 1, 0}};

bool hides(const std::vector<ConvexBlocker>& blockers) {
    BlockerPlanes planes;
    std::vector<std::uint32_t> all;
    for (const ConvexBlocker& b : blockers) {
        all.push_back(static_cast<std::uint32_t>(planes.size()));
        planes.add(b, 1e-9);
    }
    return JointShadow().hides(near_square, far_square, planes, all);
}

TEST(JointShadow, OneBlockerHidesAll) {
    EXPECT_TRUE(hides({sheet_at(5, -1, 2)}));
    EXPECT_FALSE(hides({}));
    EXPECT_FALSE(hides({sheet_at(5, -1, 0.9)}));
}

TEST(JointShadow, TwoOverlappingBlockersHideASquareTogether) {
    EXPECT_FALSE(hides({sheet_at(4, -1, 0.6)}));
    EXPECT_FALSE(hides({sheet_at(6, 0.4, 2)}));
    EXPECT_TRUE(hides({sheet_at(4, -1, 0.6), sheet_at(6, 0.2, 2)}));
}

TEST(JointShadow, NothingIsHiddenThroughAGap) {
    EXPECT_FALSE(hides({sheet_at(5, -1, 0.5), sheet_at(5, 0.51, 2)}));
    EXPECT_FALSE(hides({sheet_at(4, -1, 0.6), sheet_at(6, 0.65, 2)}));
}

TEST(JointShadow, ASolidHidesAsItsSilhouetteDoes) {
    const auto box = [](double low, double high) {
        const Point lo{4, low, -1}, hi{6, high, 2};
        ConvexBlocker b;
        for (int k = 0; k < 8; ++k) b.points.push_back({k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z});
        b.faces = {{{-1, 0, 0}, -lo.x}, {{1, 0, 0}, hi.x},   {{0, -1, 0}, -lo.y},
                   {{0, 1, 0}, hi.y},   {{0, 0, -1}, -lo.z}, {{0, 0, 1}, hi.z}};
        b.loops.resize(6);
        return b;
    };
    EXPECT_TRUE(hides({box(-0.5, 1.5)}));
    EXPECT_FALSE(hides({box(0.1, 1.5)}));
    EXPECT_TRUE(hides({box(-0.5, 0.7), box(0.3, 1.5)}));
}

}  // namespace
}  // namespace exitance

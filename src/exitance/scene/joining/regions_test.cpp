#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/scene.hpp"
#include "support/scene_sketch.hpp"

namespace exitance {
namespace {

using test::count;
using test::region;
using test::Sketch;

TEST(Regions, AnUncutFloorIsOneRegionThatStartsAtItsSmallestCorner) {
    const auto s = Sketch().add({{2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {0, 0, 0}}).light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_TRUE(s.findings.empty());
    ASSERT_EQ(s.scene->regions().size(), 2u);
    EXPECT_EQ(region(s, 0).loops, (std::vector<std::vector<Point>>{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}}));
    EXPECT_EQ(region(s, 0).area, 2);
    EXPECT_EQ(region(s, 0).plane.n, (Normal{0, 0, 1}));
}

TEST(Regions, FloorsCutWithTVerticesAreOnePolygon) {
    const auto s = Sketch().rectangle(0, 0, 1, 2).rectangle(1, 0, 2, 1).rectangle(1, 1, 2, 2).light().make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 2u);
    EXPECT_EQ(region(s, 0).surfaces.size(), 3u);
    EXPECT_EQ(region(s, 0).loops, (std::vector<std::vector<Point>>{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}}));
}

TEST(Regions, FloorsCutWithTVerticesAreOnePolygonEachInALongRow) {
    // In a long scene, the lines of short edges can hardly be distinguished: rows of such edges are compared by
    // position.
    constexpr int floors = 2000;
    for (const bool along_x : {false, true}) {
        Sketch sketch;
        for (int i = 0; i < floors; ++i) {
            const double x = along_x ? 10 * i : 0, y = along_x ? 0 : 10 * i;
            sketch.rectangle(x, y, x + 1, y + 2)
                .rectangle(x + 1, y, x + 2, y + 1)
                .rectangle(x + 1, y + 1, x + 2, y + 2);
        }
        const auto s = sketch.light().make();
        ASSERT_TRUE(s.scene);
        ASSERT_EQ(s.scene->regions().size(), floors + 1u);
        for (std::size_t i = 0; i < floors; ++i) ASSERT_NEAR(region(s, i).area, 4, 1e-6);
    }
}

TEST(Regions, FloorsCutWithTVerticesAreJoinedUnderAFarPoint) {
    // Next to coordinates as large as those of the far point, the near points have few significant digits.
    constexpr int floors = 2000;
    for (const double far : {1e3, 1e6, 1e9, 1e11}) {
        Sketch sketch;
        for (int i = 0; i < floors; ++i) {
            const double x = 10 * (i % 40), y = 10 * (i / 40);
            sketch.rectangle(x, y, x + 1, y + 2)
                .rectangle(x + 1, y, x + 2, y + 1)
                .rectangle(x + 1, y + 1, x + 2, y + 2);
        }
        sketch.add({{0, 0, 5}, {1, 0, 5}, {0, 0, far}});
        const auto s = sketch.light().make();
        ASSERT_TRUE(s.scene);
        const bool is_needle = far > 1e7;  // omitted, but its corner enlarges the scene
        EXPECT_EQ(s.scene->regions().size(), floors + (is_needle ? 1u : 2u)) << far;
    }
}

TEST(Regions, AWallOnTheJointDoesNotSeparateFloors) {
    // The wall's lower edge has the same end points as the first floor's edge, in either direction: one line with three
    // edges.
    for (const bool turned : {false, true}) {
        std::vector<Point> wall = {{1, 0, 0}, {1, 0, 1}, {1, 2, 1}, {1, 2, 0}};
        if (turned) std::reverse(wall.begin(), wall.end());
        for (const bool wall_first : {false, true}) {
            Sketch sketch;
            if (wall_first) sketch.add(wall);
            sketch.rectangle(0, 0, 1, 2);
            if (!wall_first) sketch.add(wall);
            const auto s = sketch.rectangle(1, 0, 2, 1).rectangle(1, 1, 2, 2).light().make();
            ASSERT_TRUE(s.scene);
            ASSERT_EQ(s.scene->regions().size(), 3u);
            EXPECT_EQ(region(s, wall_first ? 1 : 0).area, 4);
        }
    }
}

TEST(Regions, ATriangulatedCopyHasTheSameLoops) {
    const Point a{0, 0, 0}, b{3, 0, 0}, c{3, 3, 0}, d{1, 1, 0}, e{0, 3, 0};
    const auto whole = Sketch().add({a, b, c, d, e}).light().make();
    const auto cut = Sketch().add({a, b, d}).add({d, e, a}).add({b, c, d}).light().make();
    ASSERT_TRUE(whole.scene && cut.scene);
    EXPECT_EQ(region(whole, 0).loops, region(cut, 0).loops);
    EXPECT_EQ(region(whole, 0).plane.offset, region(cut, 0).plane.offset);
}

TEST(Regions, AFrameOfFourRectanglesHasAHole) {
    const auto s =
        Sketch().rectangle(0, 0, 3, 1).rectangle(0, 2, 3, 3).rectangle(0, 1, 1, 2).rectangle(2, 1, 3, 2).light().make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 2u);
    ASSERT_EQ(region(s, 0).loops.size(), 2u);
    EXPECT_EQ(region(s, 0).loops[0], (std::vector<Point>{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}}));
    EXPECT_EQ(region(s, 0).loops[1], (std::vector<Point>{{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}));
    EXPECT_EQ(region(s, 0).area, 8);
}

TEST(Regions, AHoleGivenByABridgeIsTheHoleOfTheSameRegion) {
    const auto s = Sketch()
                       .add({{0, 0, 0},
                             {3, 0, 0},
                             {3, 3, 0},
                             {0, 3, 0},
                             {0, 0, 0},
                             {1, 1, 0},
                             {1, 2, 0},
                             {2, 2, 0},
                             {2, 1, 0},
                             {1, 1, 0}})
                       .light()
                       .make();
    ASSERT_TRUE(s.scene);
    EXPECT_TRUE(s.findings.empty());
    ASSERT_EQ(region(s, 0).loops.size(), 2u);
    EXPECT_EQ(region(s, 0).loops[1], (std::vector<Point>{{1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}}));
    EXPECT_EQ(s.scene->outline(SurfaceId(0)).size(), 10u);
}

TEST(Regions, OtherMaterialsOtherSidesAndTouchingCornersAreNotJoined) {
    EXPECT_EQ(Sketch().rectangle(0, 0, 1, 1).rectangle(1, 0, 2, 1, 2).light().make().scene->regions().size(), 3u);
    EXPECT_EQ(Sketch().rectangle(0, 0, 1, 1).rectangle(1, 1, 2, 2).light().make().scene->regions().size(), 3u);
    const auto turned = Sketch().rectangle(0, 0, 1, 1).add({{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}}).light().make();
    EXPECT_EQ(turned.scene->regions().size(), 3u);
    const auto folded =
        Sketch().rectangle(0, 0, 1, 1).add({{1, 0, 0}, {2, 0, 0.1}, {2, 1, 0.1}, {1, 1, 0}}).light().make();
    EXPECT_EQ(folded.scene->regions().size(), 3u);
}

TEST(Regions, TwoSquaresThatMeetInACornerAndAThirdThatJoinsThemAreOneRegion) {
    const auto s = Sketch().rectangle(0, 0, 1, 1).rectangle(1, 1, 2, 2).rectangle(1, 0, 2, 1).light().make();
    ASSERT_EQ(s.scene->regions().size(), 2u);
    EXPECT_EQ(region(s, 0).loops[0].size(), 6u);
}

TEST(Regions, FacesBentWithinTheToleranceAreFlattened) {
    Sketch sketch;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const auto at = [](int x, int y) { return Point{double(x), double(y), (x + y) % 2 * 1e-6}; };
            sketch.add({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    const auto s = sketch.light().make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 2u);
    EXPECT_EQ(count(s, Finding::Kind::repair), 1);
    ASSERT_EQ(region(s, 0).loops[0].size(), 4u);
    for (std::size_t f = 0; f < 16; ++f)
        for (const Point& p : s.scene->outline(SurfaceId(f)))
            EXPECT_NEAR(region(s, 0).plane.signed_distance(p), 0, 1e-15);  // projected to the plane, up to rounding
}

TEST(Regions, AFaceThatOverlapsItsNeighbourIsNotJoinedButTheOthersAre) {
    const auto s = Sketch()
                       .rectangle(0, 0, 1, 1)
                       .rectangle(1, 0, 2, 1)
                       .rectangle(2, 0, 3, 1)
                       .add({{1, 1, 0}, {2, 1, 0}, {3, 0.2, 0}, {2, 2, 0}, {1, 2, 0}})  // overlaps the third face
                       .light()
                       .make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 3u);
    EXPECT_EQ(region(s, 0).area, 3);
    EXPECT_EQ(region(s, 0).surfaces.size(), 3u);
    ASSERT_EQ(count(s, Finding::Kind::warning), 1);
    EXPECT_EQ(s.findings[0].line, 4);
}

TEST(Regions, AFinelyCutCylinderIsNotOnePlane) {
    Sketch sketch;
    const int n = 20000;  // neighbours are tilted by 0.3 mrad, less than the tolerance for bent faces
    const auto at = [&](int i, double z) { return Point{std::cos(2 * pi * i / n), std::sin(2 * pi * i / n), z}; };
    for (int i = 0; i < n; ++i) sketch.add({at(i, 0), at((i + 1) % n, 0), at((i + 1) % n, 1), at(i, 1)});
    const auto s = sketch.light().make();
    ASSERT_TRUE(s.scene);
    double area = 0;
    for (const Region& r : s.scene->regions()) area += r.area;
    EXPECT_NEAR(area, 2 * pi + 1, 1e-5);  // the side and the light; the area of a facet has a relative error of 1e-8
    EXPECT_GT(s.scene->regions().size(), 5000u);
}

}  // namespace
}  // namespace exitance

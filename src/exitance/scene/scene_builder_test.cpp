#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exitance/scene/scene.hpp"
#include "support/scene_sketch.hpp"

namespace exitance {
namespace {

using test::count;
using test::region;
using test::Sketch;

TEST(Checks, CoincidentCornersAreMergedAndReported) {
    const auto s = Sketch().add({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->outline(SurfaceId(0)).size(), 4u);
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_EQ(s.findings[0].line, 1);
}

TEST(Checks, FacesWithoutAreaAreRemovedAndReported) {
    const auto s = Sketch()
                       .rectangle(0, 0, 1, 1)
                       .add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})
                       .add({{0, 0, 0}, {1, 0, 0}})
                       .light()
                       .make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 2u);
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_EQ(s.findings[0].line, 2);
    EXPECT_TRUE(s.findings[0].message.ends_with("(and 1 more faces without area)")) << s.findings[0].message;
}

double area_of_face_line(const CheckedScene& s, int line) {
    double sum = 0;
    for (const Surface& surface : s.scene->surfaces())
        if (surface.line == line) sum += surface.area;
    return sum;
}

TEST(Checks, ABowTieIsSplitAtItsCrossingWhetherItsPartsCancelOrNot) {
    // y = 1: parts of 1/4 m^2 each. y = 1.5: the diagonals cross at (3/5, 3/5).
    for (const auto& [y, area] : {std::pair{1.0, 0.5}, {1.5, 0.5 * 1 * 0.4 + 0.5 * 1.5 * 0.6}}) {
        const auto s = Sketch().add({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, y, 0}}).light().make();
        ASSERT_TRUE(s.scene);
        ASSERT_EQ(s.scene->surfaces().size(), 3u);
        EXPECT_NEAR(area_of_face_line(s, 1), area, 1e-12);
        EXPECT_EQ(s.scene->surfaces()[SurfaceId(0)].normal, s.scene->surfaces()[SurfaceId(1)].normal);
        ASSERT_EQ(count(s, Finding::Kind::repair), 1);
        EXPECT_NE(s.findings[0].message.find("split into 2 parts"), std::string::npos);
    }
}

TEST(Checks, ACrossedFaceIsSplitEquallyInAnyPosition) {
    const auto area = [](double size, double turn, const Vec3& shift) {
        const Frame frame(normalized(Vec3{std::cos(turn), std::sin(turn), 0.7}));
        std::vector<Point> outline;
        for (const Vec2 p : {Vec2{0, 0}, Vec2{2, 1}, Vec2{2, 0}, Vec2{0, 1.2}, Vec2{-0.5, 0.4}})
            outline.push_back(frame.to_world(size * p.x, size * p.y, 0) + shift);
        const auto s = Sketch().add(outline).light().make();
        return s.scene ? area_of_face_line(s, 1) / (size * size) : -1;
    };
    // The edges to (2, 1) and to (0, 1.2) cross where x / 2 = 1.2 - 0.6 (2 - x): x = 12/11.
    const double x = 12.0 / 11, right = 0.5 * (2 - x), left = 0.5 * 1.2 * x + 0.5 * 1.2 * 0.5;
    for (const double size : {1e-3, 1.0, 1e3}) {
        EXPECT_NEAR(area(size, 0, {}), right + left, 1e-6) << size;
        EXPECT_NEAR(area(size, 0.37, {1000, -20, 3}), right + left, 1e-6) << size;
    }
}

TEST(Checks, EveryEnclosedPartOfAnOutlineCountsOnce) {
    std::vector<Point> star;
    for (int i = 0; i < 5; ++i) star.push_back({std::cos(4 * pi * i / 5), std::sin(4 * pi * i / 5), 0});
    const auto s = Sketch().add(star).light().make();
    ASSERT_TRUE(s.scene);
    const double inner = std::cos(2 * pi / 5) / std::cos(pi / 5);  // radius of the inner corners
    EXPECT_NEAR(area_of_face_line(s, 1), 5 * inner * std::sin(pi / 5), 1e-9);
    EXPECT_EQ(s.scene->regions().size(), 2u) << "its parts are one region";

    const std::vector<Point> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    std::vector<Point> twice = square;
    twice.insert(twice.end(), square.begin(), square.end());
    const auto doubled = Sketch().add(twice).light().make();
    ASSERT_TRUE(doubled.scene);
    EXPECT_NEAR(area_of_face_line(doubled, 1), 1, 1e-12);
    EXPECT_EQ(doubled.scene->surfaces()[SurfaceId(0)].normal, (Normal{0, 0, 1}));
}

TEST(Checks, PanesAreCheckedLikeFaces) {
    Sketch sketch = Sketch().rectangle(0, 0, 1, 1).light();
    const auto pane = [&](std::vector<Point> corners) {
        Pane& p = sketch.d.panes.emplace_back();
        p.corners = std::move(corners), p.transmissivity = Spectrum(0.9), p.line = 7;
    };
    pane({{0, 0, 1}, {1, 0, 1}});                                   // degenerate: only an edge
    pane({{0, 0, 1}, {1, 0, 1}, {1, 0, 1}, {1, 1, 1}, {1, 1, 1}});  // repeated corners
    pane({{0, 0, 2}, {1, 1, 2}, {1, 0, 2}, {0, 1, 2}});             // a bow tie
    const auto s = sketch.make();
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    ASSERT_EQ(s.scene->panes().size(), 3u);
    double area = 0;
    for (const Pane& p : s.scene->panes()) area += norm(area_vector(p.corners));
    EXPECT_NEAR(area, 0.5 + 0.5, 1e-12);
    EXPECT_EQ(count(s, Finding::Kind::repair), 3);
    EXPECT_EQ(s.scene->box().hi.z, 9) << "panes do not count for the box";
}

TEST(Checks, AFaceFoldedUntilItCrossesItselfIsTwoTriangles) {
    const auto s = Sketch().add({{0, 0, 0}, {1, 1, 0.5}, {1, 0, 0}, {0, 1.5, 0.6}}).light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 3u);
    EXPECT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_NE(s.findings[0].message.find("folded"), std::string::npos);
}

TEST(Checks, BentFacesAreSplitIntoTrianglesAndReportedOnce) {
    Sketch sketch;
    sketch.add({{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}}).add({{5, 0, 0}, {6, 0, 0}, {6, 1, 0.04}, {5, 1, 0}});
    const auto s = sketch.light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 5u);
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(1)].line, 1);
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_EQ(s.findings[0].line, 1);
    EXPECT_NE(s.findings[0].message.find("0.05 m out of plane"), std::string::npos) << s.findings[0].message;
    EXPECT_NE(s.findings[0].message.find("(and 1 more faces out of plane)"), std::string::npos);
}

TEST(Checks, FacesOutOfPlaneByTheRoundingOfTheirCoordinatesAreNotReported) {
    // Coordinates of 1,200 m are rounded to 0.14 mm in single precision.
    const auto quad = [](double x, double off) {
        return Sketch().add({{x, 0, 0}, {x + 3, 0, 0}, {x + 3, 3, off}, {x, 3, 0}}).light().make();
    };
    for (const auto& [x, off, reports] :
         {std::tuple{1200.0, 1e-5, 0}, std::tuple{1200.0, 1e-3, 1}, std::tuple{0.0, 1e-5, 1}}) {
        const auto s = quad(x, off);
        ASSERT_TRUE(s.scene);
        EXPECT_EQ(count(s, Finding::Kind::repair), reports) << x << " " << off;
    }
}

TEST(Checks, ANeedleBelowSinglePrecisionIsRemoved) {
    const auto s = Sketch().rectangle(0, 0, 1, 1).add({{0, 0, 1}, {0.23, 0, 1}, {0.1, 1e-8, 1}}).light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 2u);
    EXPECT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_EQ(Sketch().add({{0, 0, 1}, {0.23, 0, 1}, {0.1, 1e-6, 1}}).light().make().scene->surfaces().size(), 2u);
}

TEST(Checks, AHoleWithTheOrientationOfItsRimIsAHole) {
    const std::vector<Point> rim{{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}};
    const std::vector<Point> hole{{1, 1, 0}, {3, 1, 0}, {3, 2, 0}, {1, 2, 0}};
    for (const bool turned : {false, true})
        for (std::size_t start = 0; start < 10; ++start) {
            std::vector<Point> outline = rim;
            outline.push_back(rim[0]);
            for (std::size_t i = 0; i <= 4; ++i) outline.push_back(hole[turned ? i % 4 : (8 - i) % 4]);
            std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(start), outline.end());
            const auto s = Sketch().add(outline).light().make();
            ASSERT_TRUE(s.scene) << s.scene.error().message;
            EXPECT_NEAR(region(s, 0).area, 10, 1e-12);
            EXPECT_NEAR(s.scene->surfaces()[SurfaceId(0)].area, 10, 1e-12);
            EXPECT_EQ(count(s, Finding::Kind::repair), turned ? 1 : 0);
        }
}

TEST(Checks, AFaceThatCrossesItselfByRoundingIsRepaired) {
    const auto s = Sketch().add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, -1e-6, 0}, {0, 1, 0}}).light().make();
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_NE(s.findings[0].message.find("by rounding"), std::string::npos);
}

TEST(Checks, WhiteIsReducedAndMoreThanWhiteIsAnError) {
    Sketch sketch = Sketch().rectangle(0, 0, 1, 1).light();
    sketch.d.materials[0].reflectance[1] = 1;
    const auto s = sketch.make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->materials()[MaterialId(0)].reflectance[1], 0.95);
    EXPECT_EQ(s.scene->materials()[MaterialId(0)].reflectance[0], 0.5);
    EXPECT_EQ(count(s, Finding::Kind::repair), 1);
    sketch.d.materials[0].reflectance[1] = 1.002;
    EXPECT_FALSE(sketch.make().scene);
}

TEST(Checks, OfFacesInOnePlaneTheLaterOneIsOnTop) {
    const auto s = Sketch().rectangle(0, 0, 4, 4).rectangle(1, 1, 3, 3, 2).rectangle(2, 2, 3.5, 3.5).light().make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 4u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(region(s, i).level, i);
    EXPECT_EQ(region(s, 3).level, 0);
    EXPECT_EQ(count(s, Finding::Kind::warning), 1);
}

TEST(Checks, AFaceThatEmitsIsOnTopOfOthersInItsPlane) {
    const auto s = Sketch().rectangle(1, 1, 3, 3, 1).rectangle(0, 0, 4, 4).rectangle(2, 2, 3.5, 3.5, 2).make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->regions().size(), 3u);
    EXPECT_EQ(region(s, 1).level, 0);
    EXPECT_EQ(region(s, 2).level, 1);
    EXPECT_EQ(region(s, 0).level, 2) << "the panel is on the ceiling and on the face that is on the ceiling";
    EXPECT_NE(s.findings[0].message.find("emits light is on top"), std::string::npos) << s.findings[0].message;
}

TEST(Checks, EqualFindingsAreReportedOnce) {
    Sketch sketch;
    for (int i = 0; i < 3; ++i) sketch.add({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
    for (auto& face : sketch.rectangle(0, 0, 1, 1).light().d.faces) face.line = 0;  // no line numbers, as in glTF files
    const auto s = sketch.make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_NE(s.findings[0].message.find("(and 2 more faces without area)"), std::string::npos)
        << s.findings[0].message;
}

TEST(Checks, EveryErrorIsReported) {
    Sketch sketch;
    sketch.add({{0, 0, 0}, {1, 0, 0}, {1e30, 1, 0}, {0, 1, 0}})
        .add({{0, 0, 0}, {1, 1, 0}, {1, 0, 1e40}, {0, 1.5, 0}})
        .light();
    sketch.d.materials[0].reflectance[1] = 1.25;
    const auto s = sketch.make();
    EXPECT_EQ(count(s, Finding::Kind::error), 3);
    EXPECT_NE(s.scene.error().message.find("2 more errors"), std::string::npos);
}

TEST(Checks, ARepeatedFaceIsRemovedNamingBothLines) {
    const auto s = Sketch().rectangle(0, 0, 1, 1).light().add({{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}}).make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 2u);
    ASSERT_EQ(count(s, Finding::Kind::repair), 1);
    EXPECT_EQ(s.findings[0].line, 3);
    EXPECT_NE(s.findings[0].message.find("line 1"), std::string::npos);
}

TEST(Checks, AFaceThatCoversAnotherCausesAWarningNamingBothLines) {
    const auto s = Sketch().rectangle(0, 0, 2, 2).light().rectangle(1, 1, 3, 3, 2).make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(count(s, Finding::Kind::warning), 1);
    EXPECT_EQ(s.findings[0].line, 3);
    EXPECT_NE(s.findings[0].message.find("line 1"), std::string::npos);
    EXPECT_NE(s.findings[0].message.find("1 m^2"), std::string::npos) << s.findings[0].message;
}

TEST(Checks, EveryFaceThatCoversALargerOneIsReported) {
    Sketch sketch;
    for (int i = 0; i < 9; ++i) sketch.rectangle(i, 0, i + 0.5, 1);  // all nine overlap the last face
    const auto s = sketch.light().rectangle(-1, -1, 10, 2, 2).make();
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(count(s, Finding::Kind::warning), 1);
    EXPECT_TRUE(s.findings[0].message.ends_with("(and 8 more faces that cover another)"));
}

TEST(Checks, AHeapOfFacesInOnePlaneIsNotComparedCompletely) {
    constexpr int faces = 3000;  // 4.5 million overlapping pairs
    Sketch sketch;
    for (int i = 0; i < faces; ++i) sketch.rectangle(i, i, faces + i, faces + i, 2 * (i % 2));
    const auto s = sketch.light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), faces + 1u);
    std::size_t covering = 0;
    for (const Mark& mark : s.marks) covering += mark.kind == Mark::Kind::covering;
    EXPECT_GE(covering, faces - 1u);
    EXPECT_LE(covering, 4u * faces);
}

TEST(Checks, FacesBackToBackBesideEachOtherOrInAHoleAreNoOverlap) {
    Sketch sketch =
        Sketch().rectangle(0, 0, 3, 1).rectangle(0, 2, 3, 3).rectangle(0, 1, 1, 2).rectangle(2, 1, 3, 2).light();
    sketch.rectangle(1, 1, 2, 2, 2).rectangle(3, 0, 4, 3, 2).add({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});
    const auto s = sketch.make();
    ASSERT_TRUE(s.scene);
    EXPECT_TRUE(s.findings.empty()) << s.findings[0].message;
}

TEST(Checks, LobesOfOppositeOrientationThatShareACornerAreSplit) {
    const Point v{0, 0, 0};
    const auto s = Sketch().add({v, {2, -1, 0}, {2, 1, 0}, v, {-1, -0.5, 0}, {-1, 0.5, 0}}).light().make();
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 3u);
    EXPECT_NEAR(area_of_face_line(s, 1), 2.5, 1e-12);
    const auto proper = Sketch().add({v, {2, -1, 0}, {2, 1, 0}, v, {-1, 0.5, 0}, {-1, -0.5, 0}}).light().make();
    EXPECT_TRUE(proper.scene);
}

TEST(Checks, ASceneWithoutLightIsReportedAndOneWithoutFacesIsAnError) {
    const auto dark = Sketch().rectangle(0, 0, 1, 1).make();
    EXPECT_TRUE(dark.scene);
    EXPECT_EQ(count(dark, Finding::Kind::warning), 1);
    EXPECT_FALSE(Sketch().make().scene);
}

TEST(Checks, InvalidNumbersAndIndicesAreErrors) {
    Sketch far = Sketch().rectangle(0, 0, 1, 1).light();
    far.d.faces[0].corners[2] = 99;
    EXPECT_FALSE(far.make().scene);
    Sketch nowhere = Sketch().rectangle(0, 0, 1, 1).light();
    nowhere.d.points[1].x = std::nan("");
    EXPECT_FALSE(nowhere.make().scene);
    Sketch nameless = Sketch().rectangle(0, 0, 1, 1).light();
    nameless.d.faces[0].material = 7;
    EXPECT_FALSE(nameless.make().scene);
    Sketch cold = Sketch().rectangle(0, 0, 1, 1).light();
    cold.d.materials[1].exitance[0] = -1;
    EXPECT_FALSE(cold.make().scene);
}

TEST(Checks, HugeCoordinatesAreAnErrorAndAffectNothingElse) {
    const auto s = Sketch().rectangle(0, 0, 1, 1).light().add({{1e30, 0, 0}, {1e30, 1e30, 0}, {0, 1e30, 0}}).make();
    ASSERT_FALSE(s.scene);
    EXPECT_EQ(s.scene.error().message, "a corner of the face lies at (1e+30, 0, 0) m");
    EXPECT_EQ(s.findings.size(), 1u);  // the small faces were not reduced to points
    Sketch blinding = Sketch().rectangle(0, 0, 1, 1).light();
    blinding.d.materials[1].exitance[0] = 1e300;
    EXPECT_FALSE(blinding.make().scene);
}

TEST(Checks, AFaceWithTooManyCornersIsAnErrorWithTheirNumber) {
    std::vector<Point> circle(10'001);
    for (std::size_t i = 0; i < circle.size(); ++i) {
        const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(circle.size());
        circle[i] = {std::cos(angle), std::sin(angle), 0};
    }
    const auto s = Sketch().add(circle).light().make();
    ASSERT_FALSE(s.scene);
    EXPECT_EQ(s.scene.error().message, "face has 10001 corners; 10000 are the most");
}

TEST(Checks, ScenesMayBeTinyHugeAndFarAway) {
    for (double scale : {1e-6, 1.0, 1e8})
        for (double shift : {0.0, 1e6}) {
            Sketch sketch = Sketch().rectangle(0, 0, 1, 2).rectangle(1, 0, 2, 1).rectangle(1, 1, 2, 2).light();
            for (Point& p : sketch.d.points) p = scale * (p + Vec3{shift, -shift, shift / 2});
            const auto s = sketch.make();
            ASSERT_TRUE(s.scene);
            ASSERT_EQ(s.scene->regions().size(), 2u);
            EXPECT_EQ(region(s, 0).loops[0].size(), 4u);
        }
}

TEST(Checks, ScenesAndLightTooSmallForTheNumbersAreErrors) {
    const auto scaled = [](double size, double light) {
        Sketch sketch = Sketch().rectangle(0, 0, 1, 2).rectangle(1, 0, 2, 1).light();
        for (Point& p : sketch.d.points) p = size * p;
        for (double& band : sketch.d.materials[1].exitance.value) band *= light;
        const auto s = sketch.make();
        return s.scene ? std::string() : s.scene.error().message;
    };
    for (const double size : {1e-14, 1e-20, 1e-100, 1e-200, 1e-310})
        EXPECT_NE(scaled(size, 1).find("m large"), std::string::npos) << size << ": " << scaled(size, 1);
    for (const double light : {1e-35, 1e-100, 1e-200, 1e-310})
        EXPECT_NE(scaled(1, light).find("the brightest light"), std::string::npos) << light << ": " << scaled(1, light);
    EXPECT_EQ(scaled(1e-11, 1e-25), "");
    EXPECT_EQ(scaled(1, 0), "");
}

TEST(Checks, AFarHorizonDoesNotMergeNearPoints) {
    Sketch sketch;
    sketch.add({{-1e7, -1e7, -1}, {1e7, -1e7, -1}, {1e7, 1e7, -1}, {-1e7, 1e7, -1}}, 2).light();
    for (int i = 0; i < 300; ++i) sketch.rectangle(0.01 * i, 0, 0.01 * i + 0.005, 0.005);
    const auto s = sketch.make();
    ASSERT_TRUE(s.scene);
    EXPECT_TRUE(s.findings.empty());
    EXPECT_EQ(s.scene->regions().size(), 302u);
}

}  // namespace
}  // namespace exitance

#include "exitance/scene/shell.hpp"

#include <gtest/gtest.h>

#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {

TEST(Shell, AClosedBoxIsClosedAndOfOneSense) {
    const Shell shell = inspect_shell(test::make(test::closed_box({0, 0, 0}, {1, 2, 3})));
    EXPECT_EQ(shell.open_edges, 0u);
    EXPECT_EQ(shell.t_joints, 0u);
    EXPECT_TRUE(shell.turned.empty());
}

TEST(Shell, ATurnedFaceIsFoundByItsNeighbours) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {1, 2, 3});
    std::reverse(faces[2].corners.begin(), faces[2].corners.end());
    const Scene scene = test::make(faces);
    const Shell shell = inspect_shell(scene);
    EXPECT_EQ(shell.turned, std::vector<SurfaceId>{SurfaceId(2)});
    const auto findings = findings_of(shell, scene);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_NE(findings[0].message.find("'all'"), std::string::npos);
}

TEST(Shell, AMissingFaceLeavesItsEdgesOpen) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    faces.pop_back();
    const Shell shell = inspect_shell(test::make(faces));
    EXPECT_EQ(shell.open_edges, 4u);
    EXPECT_NEAR(shell.open_length, 4, 1e-12);
}

TEST(Shell, TJointsAreNoOpenings) {
    // One side of a box in two halves: the long edges above and below hold a corner each.
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    const std::vector<Point> q = faces[0].corners;
    const Point a = 0.5 * (q[0] + q[1]), b = 0.5 * (q[3] + q[2]);
    faces[0].corners = {q[0], a, b, q[3]};
    faces.push_back({{a, q[1], q[2], b}});
    const Shell shell = inspect_shell(test::make(faces));
    EXPECT_EQ(shell.open_edges, 0u);
    EXPECT_EQ(shell.t_joints, 2u);
    EXPECT_TRUE(shell.turned.empty());
}

TEST(Shell, FamiliesHaveNoTurnedFaces) {
    for (const char* family : {"cornell", "boxes", "gcr2", "complex"})
        EXPECT_TRUE(inspect_shell(built_scene(family)).turned.empty()) << family;
}

TEST(Shell, ASheetWithTwoSidesIsNeitherOpenNorTurned) {
    const std::vector<Point> sheet = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const Shell shell = inspect_shell(test::make({{sheet}, {{sheet.rbegin(), sheet.rend()}}}));
    EXPECT_EQ(shell.open_edges, 0u);
    EXPECT_TRUE(shell.turned.empty());
}

}  // namespace exitance

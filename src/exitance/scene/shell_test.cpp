#include "exitance/scene/shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "support/built_scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {

TEST(Shell, AClosedBoxIsClosedAndConsistentlyOriented) {
    const Shell shell = inspect_shell(test::make(test::closed_box({0, 0, 0}, {1, 2, 3})));
    EXPECT_EQ(shell.open_edges, 0u);
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

/// Five outer walls of a box, and a ceiling inside that shares one edge with them. `own_group`: it is another object.
Scene walls_with_ceiling(bool own_group) {
    SceneDescription d;
    d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},   {0, 0, 1},
                {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0.9, 1}, {0, 0.9, 1}};
    d.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    d.groups = {"walls", "ceiling"};
    for (const auto& outline :
         std::vector<std::vector<std::uint32_t>>{{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}})
        d.faces.push_back({.corners = outline});
    d.faces.push_back({.corners = {4, 9, 8, 5}, .group = own_group ? 1u : 0u});
    return std::move(*make_scene(d).scene);
}

TEST(Shell, AnotherObjectThatTouchesAlongOneEdgeIsNotTurned) {
    EXPECT_TRUE(inspect_shell(walls_with_ceiling(true)).turned.empty());
    EXPECT_EQ(inspect_shell(walls_with_ceiling(false)).turned, std::vector<SurfaceId>{SurfaceId(5)});
}

TEST(Shell, AMissingFaceLeavesItsEdgesOpen) {
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    faces.pop_back();
    const Shell shell = inspect_shell(test::make(faces));
    EXPECT_EQ(shell.open_edges, 4u);
    EXPECT_NEAR(shell.open_length, 4, 1e-12);
}

TEST(Shell, TJointsAreNoOpenings) {
    // One side of a box in two halves: the long edges above and below contain a corner each.
    std::vector<test::Face> faces = test::closed_box({0, 0, 0}, {1, 1, 1});
    const std::vector<Point> q = faces[0].corners;
    const Point a = 0.5 * (q[0] + q[1]), b = 0.5 * (q[3] + q[2]);
    faces[0].corners = {q[0], a, b, q[3]};
    faces.push_back({{a, q[1], q[2], b}});
    const Shell shell = inspect_shell(test::make(faces));
    EXPECT_EQ(shell.open_edges, 0u);
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

TEST(Shell, ATurnedSheetEnclosesNothing) {
    // The corners are rounded to twelve digits, so that the volume between the sides is not exactly zero.
    const std::vector<Point> sheet = {{2.02685798172, 2.74722807088, 1.70721546634},
                                      {2.81059814707, 2.73432169667, 1.54726303994},
                                      {2.82404315086, 1.9449983134, 1.67683089278},
                                      {2.0403029855, 1.95790468761, 1.83678331918}};
    for (std::size_t first = 0; first < 4; ++first) {
        std::vector<Point> front = sheet;
        std::rotate(front.begin(), front.begin() + static_cast<std::ptrdiff_t>(first), front.end());
        const std::vector<test::Face> room = test::closed_box({0, 0, 0}, {4, 4, 3});
        std::vector<test::Face> faces(room);
        faces.push_back({front, 10}), faces.push_back({{sheet.rbegin(), sheet.rend()}});
        EXPECT_TRUE(inspect_shell(test::make(faces)).inside_out.empty()) << first;
    }
}

/// The faces of a box with their fronts inside, like a room, or outside.
std::vector<test::Face> box(const Point& lo, const Point& hi, bool inwards,
                            const std::vector<test::Face>& others = {}) {
    std::vector<test::Face> faces = test::closed_box(lo, hi);
    const Vec3 to_middle = 0.5 * (lo + hi) - faces[0].corners[0];
    if ((dot(area_vector(faces[0].corners), to_middle) > 0) != inwards)
        for (test::Face& face : faces) std::reverse(face.corners.begin(), face.corners.end());
    faces.insert(faces.begin(), others.begin(), others.end());
    return faces;
}

std::vector<std::size_t> sizes(const Shell& shell) {
    std::vector<std::size_t> out;
    for (const InsideOut& body : shell.inside_out) out.push_back(body.faces.size());
    return out;
}

TEST(Shell, FurnitureInARoomIsInsideOutIfItLooksInwards) {
    const std::vector<test::Face> room = box({0, 0, 0}, {4, 3, 2.5}, true);
    const Shell wrong = inspect_shell(test::make(box({1, 1, 0.5}, {2, 2, 1}, true, room)));
    ASSERT_EQ(sizes(wrong), std::vector<std::size_t>{6});
    EXPECT_EQ(wrong.inside_out[0].faces[0], 6u);
    EXPECT_FALSE(wrong.inside_out[0].is_room);
    EXPECT_TRUE(inspect_shell(test::make(box({1, 1, 0.5}, {2, 2, 1}, false, room))).inside_out.empty());
}

TEST(Shell, ABodyWithTJointsIsClassifiedToo) {
    const std::vector<test::Face> room = box({0, 0, 0}, {4, 3, 2.5}, true);
    std::vector<test::Face> faces = box({1, 1, 0.5}, {2, 2, 1}, true, room);
    const std::vector<Point> q = faces[6].corners;
    const Point a = 0.5 * (q[0] + q[1]), b = 0.5 * (q[3] + q[2]);
    faces[6].corners = {q[0], a, b, q[3]};
    faces.push_back({{a, q[1], q[2], b}});
    EXPECT_EQ(sizes(inspect_shell(test::make(faces))), std::vector<std::size_t>{7});
}

TEST(Shell, FurnitureThatLiesOnFloorAndWallsIsJudged) {
    const std::vector<test::Face> room = box({0, 0, 0}, {4, 3, 2.5}, true);
    const std::array<std::pair<Point, Point>, 5> places{{{{1, 1, 0}, {2, 2, 1}},  // box on the floor
                                                                                  // box on the floor and against a wall
                                                         {{1, 0, 0}, {2, 0.5, 2}},
                                                         {{0, 0, 0}, {0.6, 0.5, 2}},    // box in a corner
                                                         {{0, 0, 0}, {0.6, 0.5, 2.5}},  // box from floor to ceiling
                                                         {{1, 0, 1.5}, {2, 0.3, 2.5}}}};
    for (const auto& [lo, hi] : places) {
        EXPECT_EQ(sizes(inspect_shell(test::make(box(lo, hi, true, room)))), std::vector<std::size_t>{6})
            << lo.x << " " << lo.y << " " << lo.z;
        EXPECT_TRUE(inspect_shell(test::make(box(lo, hi, false, room))).inside_out.empty());
    }
    // Two cupboards side by side, of different heights, the second of which is inside out.
    const std::vector<test::Face> first = box({1, 0, 0}, {2, 0.5, 2}, false, room);
    const Shell shell = inspect_shell(test::make(box({2, 0, 0}, {3, 0.5, 1.5}, true, first)));
    ASSERT_EQ(sizes(shell), std::vector<std::size_t>{6});
    EXPECT_EQ(shell.inside_out[0].faces[0], 12u);
}

TEST(Shell, EachOfThousandsOfSmallBodiesIsJudged) {
    // Leaves as tetrahedra in a room with a lamp; every third one is inside out.
    std::vector<test::Face> faces = box({-3, -3, -3}, {3, 3, 3}, true);
    faces.push_back({{{0, 0, 2.9}, {0, 1, 2.9}, {1, 1, 2.9}, {1, 0, 2.9}}, 1});
    RandomStream random(1, Stream::mesh);
    constexpr std::size_t leaves = 3000;
    for (std::size_t i = 0; i < leaves; ++i) {
        const Point a = 4 * test::any_in_cube(random);
        std::array<Point, 4> p{a, a + 0.1 * test::any_in_cube(random), a + 0.1 * test::any_in_cube(random),
                               a + 0.1 * test::any_in_cube(random)};
        // Outwards: the fourth corner lies behind the first three.
        if (dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) > 0) std::swap(p[1], p[2]);
        if (i % 3 == 0) std::swap(p[1], p[2]);
        for (const auto& f : {std::array{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
            faces.push_back({{p[static_cast<std::size_t>(f[0])], p[static_cast<std::size_t>(f[1])],
                              p[static_cast<std::size_t>(f[2])]}});
    }
    const std::vector<std::size_t> found = sizes(inspect_shell(test::make(faces)));
    // Only few boxes are inside of others, which makes them cavities.
    EXPECT_NEAR(static_cast<double>(found.size()), leaves / 3.0, 0.02 * leaves);
    EXPECT_EQ(*std::max_element(found.begin(), found.end()), 4u);
}

TEST(Shell, CavitiesOfSolidBodiesAndRoomsSideBySideAreNotInsideOut) {
    const std::vector<test::Face> house = box({-0.2, -0.2, -0.2}, {4.2, 3.2, 2.7}, false);
    const std::vector<test::Face> rooms = box({0, 0, 0}, {2, 3, 2.5}, true, box({2.1, 0, 0}, {4, 3, 2.5}, true, house));
    EXPECT_TRUE(inspect_shell(test::make(rooms)).inside_out.empty());
    // A cupboard in one of the rooms of the house: three levels of nesting.
    EXPECT_EQ(sizes(inspect_shell(test::make(box({0.5, 0.5, 0.5}, {1, 1, 1}, true, rooms)))),
              std::vector<std::size_t>{6});
    const std::vector<test::Face> touching = box({0, 0, 0}, {2, 3, 2.5}, true, box({2, 0, 0}, {4, 3, 2.5}, true));
    EXPECT_TRUE(inspect_shell(test::make(touching)).inside_out.empty());
}

TEST(Shell, ASolidBodyWithWallsOfTwoSidesIsNotInsideOut) {
    const std::vector<test::Face> room = box({0, 0, 0}, {4, 3, 2.5}, true);
    const std::vector<test::Face> both = box({1, 1, 0.5}, {2, 2, 1}, false, box({1, 1, 0.5}, {2, 2, 1}, true, room));
    EXPECT_TRUE(inspect_shell(test::make(both)).inside_out.empty());
}

}  // namespace exitance

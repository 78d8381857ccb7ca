#include "exitance/visibility/convex_blockers.hpp"

#include <gtest/gtest.h>

#include <array>

namespace exitance {
namespace {

/// Adds the six faces of a box, facing outwards or inwards.
void add_box(SceneDescription& scene, const Point& lo, const Point& hi, bool outwards) {
    const auto first = static_cast<std::uint32_t>(scene.points.size());
    for (int i = 0; i < 8; ++i) scene.points.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
    constexpr std::array<std::array<std::uint32_t, 4>, 6> faces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& f : faces) {
        SceneDescription::Face face;
        for (std::uint32_t c : f) face.corners.push_back(first + c);
        if (!outwards) std::reverse(face.corners.begin(), face.corners.end());
        scene.faces.push_back(face);
    }
}

Scene room_with_two_boxes_and_a_sheet() {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.5), Spectrum()});
    d.groups.push_back("all");
    add_box(d, {0, 0, 0}, {4, 4, 3}, false);
    add_box(d, {1, 1, 0.5}, {2, 2, 1}, true);
    add_box(d, {3, 3, 0.5}, {3.5, 3.5, 1}, true);
    const auto first = static_cast<std::uint32_t>(d.points.size());
    for (const Point& p : {Point{0.5, 3, 1}, Point{1, 3, 1}, Point{1, 3.5, 1}}) d.points.push_back(p);
    d.faces.push_back({{first, first + 1, first + 2}, 0, 0, 0});
    return *make_scene(d).scene;
}

TEST(ConvexBlockers, AreBodiesAndSheetsButNotTheWallsOfAConvexRoom) {
    const Scene scene = room_with_two_boxes_and_a_sheet();
    const std::vector<ConvexBlocker> blockers = make_convex_blockers(Occluders(scene), 1e-7);
    ASSERT_EQ(blockers.size(), 3u);
    for (std::size_t b = 0; b < 2; ++b) {
        EXPECT_TRUE(blockers[b].is_solid());
        EXPECT_EQ(blockers[b].points.size(), 8u);
        EXPECT_EQ(blockers[b].edges.size(), 12u);
        EXPECT_EQ(blockers[b].faces.size(), 6u);
    }
    EXPECT_FALSE(blockers[2].is_solid());
    EXPECT_EQ(blockers[2].edges.size(), 3u);
}

double volume(const ConvexBlocker& body) {
    double sum = 0;
    for (std::size_t k = 0; k < body.faces.size(); ++k) {
        std::vector<Point> outline;
        for (std::uint32_t c : body.loops[k]) outline.push_back(body.points[c]);
        sum += dot(area_vector(outline), outline[0]) / 3;
    }
    return sum;
}

TEST(ConvexBlockers, AreClosedAgainWhenAPlaneCutsThem) {
    const Scene scene = room_with_two_boxes_and_a_sheet();
    const ConvexBlocker box = make_convex_blockers(Occluders(scene), 1e-7)[0];
    ConvexBlocker front, back;
    for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{1, 2, 0}, Vec3{1, -2, 3}, Vec3{-0.1, 1, 0.2}}) {
        const Normal n = normalized(direction);
        const Plane plane = {n, dot(n, Point{1.4, 1.6, 0.7})};
        ASSERT_TRUE(clip_body(box, plane, 1e-7, front));
        ASSERT_TRUE(clip_body(box, {-n, -plane.offset}, 1e-7, back));
        EXPECT_NEAR(volume(front) + volume(back), 0.5, 1e-14);  // outlines point outwards, including the new faces
        EXPECT_EQ(front.points.size() + front.faces.size(), front.edges.size() + 2);
        for (const ConvexBlocker* part : {&front, &back})
            for (const Plane& face : part->faces)
                for (const Point& p : part->points) EXPECT_LE(face.signed_distance(p), 1e-14);
    }
    // Along a diagonal through four corners, and next to it.
    const Normal n = normalized(Vec3{1, -1, 0});
    ASSERT_TRUE(clip_body(box, {n, 0}, 1e-7, front));
    EXPECT_EQ(front.points.size(), 6u);
    EXPECT_NEAR(volume(front), 0.25, 1e-15);
    ASSERT_TRUE(clip_body(box, {{0, 0, 1}, 1}, 1e-7, front));
    EXPECT_TRUE(front.points.empty());
    ASSERT_TRUE(clip_body(box, {{0, 0, 1}, 0.5}, 1e-7, front));
    EXPECT_EQ(front.faces.size(), 6u);
}

SceneDescription room_with_a_house() {
    SceneDescription d;
    d.materials.push_back({"grey", Spectrum(0.5), Spectrum()});
    d.groups.push_back("all");
    add_box(d, {0, 0, 0}, {4, 4, 3}, false);
    add_box(d, {1, 1, 0}, {2, 2, 1}, true);
    d.faces.erase(d.faces.begin() + 6);  // a box on the ground without a bottom
    return d;
}

TEST(ConvexBlockers, ABoxWithoutItsBottomBlocksAsOneBody) {
    const Scene scene = *make_scene(room_with_a_house()).scene;
    const std::vector<ConvexBlocker> blockers = make_convex_blockers(Occluders(scene), 1e-7);
    ASSERT_EQ(blockers.size(), 1u);
    EXPECT_EQ(blockers[0].faces.size(), 6u);
    EXPECT_EQ(blockers[0].edges.size(), 12u);
    EXPECT_NEAR(volume(blockers[0]), 1, 1e-12);
}

TEST(ConvexBlockers, ABoxWithoutItsBottomIsFiveSheetsWhenSomethingStandsWithin) {
    SceneDescription d = room_with_a_house();
    add_box(d, {1.4, 1.4, 0.2}, {1.6, 1.6, 0.4}, true);
    const Scene scene = *make_scene(d).scene;
    EXPECT_EQ(make_convex_blockers(Occluders(scene), 1e-7).size(), 5u + 1u);
}

TEST(ConvexBlockers, ABoxWithoutTwoOfItsSidesStaysInSheets) {
    SceneDescription d = room_with_a_house();
    d.faces.pop_back();
    const Scene scene = *make_scene(d).scene;
    EXPECT_EQ(make_convex_blockers(Occluders(scene), 1e-7).size(), 4u);
}

TEST(ConvexBlockers, PolygonsOnOneSideOfAFaceSeeEachOtherPastTheBody) {
    const Scene scene = room_with_two_boxes_and_a_sheet();
    const std::vector<ConvexBlocker> blockers = make_convex_blockers(Occluders(scene), 1e-7);
    const std::array<Point, 3> above = {{{0, 0, 1.5}, {1, 0, 1.5}, {0, 1, 1.5}}};
    const std::array<Point, 3> touching = {{{0, 0, 1}, {1, 0, 1.5}, {0, 1, 1.5}}};
    const std::array<Point, 3> below = {{{1.2, 1.2, 0.1}, {1.5, 1.2, 0.1}, {1.2, 1.5, 0.1}}};
    EXPECT_NE(sides(blockers[0], above, 1e-7) & sides(blockers[0], touching, 1e-7), 0u);
    EXPECT_EQ(sides(blockers[0], above, 1e-7) & sides(blockers[0], below, 1e-7), 0u);
}

}  // namespace
}  // namespace exitance

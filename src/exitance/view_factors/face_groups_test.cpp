#include "exitance/view_factors/face_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/base/random.hpp"
#include "support/outline_scene.hpp"

namespace exitance {
namespace {

constexpr double joined_within = 1e-7;  // metres

/// Faces as they are, without the joining of a scene, which would give equal corners to all of them.
struct Faces {
    explicit Faces(Outlines o) : outlines(std::move(o)) {
        for (const Outline& outline : outlines) {
            const Normal n = normalized(area_vector(outline));
            ViewFace& face = all.emplace_back();
            face.outline = outline, face.plane = {n, dot(n, outline[0])};
            for (const Point& p : outline) face.box.add(p);
        }
    }
    Outlines outlines;
    std::vector<ViewFace> all;
};

TEST(FaceGroups, ABoxIsAClosedGroupAndBoundsASolid) {
    Outlines outlines;
    add_box_faces(outlines, {0, 0, 0}, {1, 2, 3});
    add_box_faces(outlines, {2, 0, 0}, {3, 1, 1});
    const Faces faces(outlines);
    const FaceGroups groups(faces.all, joined_within);
    ASSERT_EQ(groups.all().size(), 2u);
    EXPECT_TRUE(groups.of(3).bounds_solid());
    EXPECT_EQ(groups.of(3).faces, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(groups.of(7).box.hi.x, 3);
}

TEST(FaceGroups, ABoxWithoutALidAndASheetBoundNoSolid) {
    Outlines outlines;
    add_box_faces(outlines, {0, 0, 0}, {1, 2, 3});
    outlines.erase(outlines.begin());
    Outline sheet = {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
    outlines.push_back(sheet);
    std::reverse(sheet.begin(), sheet.end());
    outlines.push_back(sheet);
    const Faces faces(outlines);
    const FaceGroups groups(faces.all, joined_within);
    ASSERT_EQ(groups.all().size(), 2u);
    EXPECT_FALSE(groups.of(0).is_closed);
    EXPECT_TRUE(groups.of(5).is_closed);
    EXPECT_TRUE(groups.of(5).is_flat);
    EXPECT_FALSE(groups.of(5).bounds_solid());
}

TEST(FaceGroups, CornersDifferByRoundingWhereverTheyAre) {
    RandomStream random(1, Stream::reference, 0);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Point low{random.uniform(), random.uniform(), random.uniform()};
        Outlines outlines;
        add_box_faces(outlines, low, low + Vec3{1, 1, 1});
        for (Outline& outline : outlines)
            for (Point& p : outline)
                p = p + joined_within * Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
        const Faces faces(outlines);
        const FaceGroups groups(faces.all, joined_within);
        ASSERT_EQ(groups.all().size(), 1u);
        EXPECT_TRUE(groups.of(0).is_closed);
    }
}

TEST(FaceGroups, AShellAroundABoxIsHollow) {
    const auto solid_of = [](const Outlines& outlines) {
        const Scene scene = scene_of(outlines);
        return make_solid_blockers(Occluders(scene), joined_within);
    };
    Outlines shell;
    add_box_faces(shell, {0, 0, 0}, {4, 4, 4});
    const std::vector<ConvexBlocker> solids = solid_of(shell);
    ASSERT_EQ(solids.size(), 1u);
    Outlines inside = shell, beside = shell;
    add_box_faces(inside, {1, 1, 1}, {2, 2, 2});
    add_box_faces(beside, {3, 1, 1}, {5, 2, 2});
    const Faces with_inside(inside), with_beside(beside);
    EXPECT_TRUE(FaceGroups(with_inside.all, joined_within).is_hollow(solids[0]));
    EXPECT_FALSE(FaceGroups(with_beside.all, joined_within).is_hollow(solids[0]));
}

}  // namespace
}  // namespace exitance

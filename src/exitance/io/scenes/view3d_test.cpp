#include "exitance/io/scenes/view3d.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "exitance/io/scenes/scene_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

const std::string square = "V 1 0 0 0\nV 2 4 0 0\nV 3 4 4 0\nV 4 0 4 0\nV 5 1 1 0\nV 6 3 1 0\nV 7 3 3 0\nV 8 1 3 0\n";

ReadScene read_vs3_text(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.vs3") << text;
    return read_view3d(folder / "s.vs3");
}

CheckedScene load(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "s.vs3") << text;
    return load_scene(folder / "s.vs3");
}

TEST(View3d, ReadsLettersOfEitherCaseCommasCommentsAndTriangles) {
    const ReadScene scene = read_vs3_text("t a title ! with a mark\nc eps=1e-5, encl=0\nf 3\n" + square +
                                          "s 1,1,2,3,4,0,0,0.75,floor ! a comment\nS 2 5 7 6 0 0 0 0.5 lid / another\n"
                                          "e the end\nS 3 nonsense\n");
    EXPECT_TRUE(scene.findings.empty());
    const SceneDescription& d = scene.description;
    ASSERT_EQ(d.faces.size(), 2u);
    EXPECT_EQ(d.faces[0].corners.size(), 4u);
    EXPECT_EQ(d.faces[1].corners.size(), 3u);
    EXPECT_EQ(d.groups, (std::vector<std::string>{"floor", "lid", view3d_obstructions}));
    EXPECT_DOUBLE_EQ(d.materials[0].reflectance[0], 0.25);
    EXPECT_DOUBLE_EQ(d.materials[1].reflectance[0], 0.5);
}

TEST(View3d, AWindowIsCutOutOfItsWall) {
    const CheckedScene checked =
        load("F 3\n" + square + "S 1 1 2 3 4 0 0 0.9 wall\nS 2 5 6 7 8 1 0 0.9 window\nO 3 1 2 3 4\nE\n");
    ASSERT_TRUE(checked.scene);
    double wall = 0, window = 0, obstructions = 0;
    for (const Surface& s : checked.scene->surfaces()) {
        const std::string& group = checked.scene->groups()[s.group];
        (group == "wall" ? wall : group == "window" ? window : obstructions) += s.area;
    }
    EXPECT_NEAR(wall, 12, 1e-12);
    EXPECT_NEAR(window, 4, 1e-12);
    EXPECT_NEAR(obstructions, 16, 1e-12);
}

TEST(View3d, MergedPiecesAreOneGroup) {
    const ReadScene scene =
        read_vs3_text("F 3\n" + square + "S 1 1 2 3 0 0 0 .9 a\nS 2 1 3 4 0 0 1 .9 b\nS 3 5 8 7 6 0 0 .9\n");
    ASSERT_EQ(scene.description.faces.size(), 3u);
    EXPECT_EQ(scene.description.faces[0].group, scene.description.faces[1].group);
    EXPECT_EQ(scene.description.groups[scene.description.faces[2].group], "surface 3");
}

TEST(View3d, PlanesOfFormatF3aHaveTheRightPosition) {
    // Azimuth 0 faces north; the plane is upright: u points to -x, v up.
    const CheckedScene checked = load("F 3a\nS 1 R 0 0 .9 wall\n10 20 1 0 90\n 3 2\nE\n");
    ASSERT_TRUE(checked.scene);
    const Surface& wall = checked.scene->surfaces()[SurfaceId(0)];
    EXPECT_NEAR(wall.area, 6, 1e-12);
    EXPECT_NEAR(std::abs(wall.normal.y), 1, 1e-12);
    EXPECT_NEAR(checked.scene->box().lo.x, 7, 1e-12);
    EXPECT_NEAR(checked.scene->box().hi.z, 3, 1e-12);
}

TEST(View3d, AQuadrangleThatCrossesItselfIsSplitAtTheCrossing) {
    // Corners 3 and 4 are exchanged: two triangles of 4 m^2 meet at (2, 2).
    const CheckedScene checked = load("F 3\n" + square + "S 1 1 2 4 3 0 0 0.9 bow\nS 2 8 7 6 5 0 0 0.9 lid\nE\n");
    ASSERT_TRUE(checked.scene);
    double area = 0;
    std::size_t faces = 0;
    for (const Surface& s : checked.scene->surfaces()) {
        if (checked.scene->groups()[s.group] != "bow") continue;
        area += s.area, ++faces;
        EXPECT_NEAR(s.area, 4, 1e-9);
    }
    EXPECT_EQ(faces, 2u);
    EXPECT_NEAR(area, 8, 1e-9);
    std::size_t repairs = 0;
    for (const Finding& f : checked.findings) repairs += f.kind == Finding::Kind::repair;
    EXPECT_EQ(repairs, 1u);
}

TEST(View3d, ACrossedQuadrangleWithASubsurfaceIsAnError) {
    const CheckedScene checked = load("F 3\n" + square + "S 1 1 2 4 3 0 0 .9 bow\nS 2 5 6 7 8 1 0 .9 part\nE\n");
    ASSERT_FALSE(checked.scene);
    EXPECT_NE(checked.scene.error().message.find("crosses itself"), std::string::npos);
}

TEST(View3d, InputThatView3dRejectsIsAnErrorWithItsLine) {
    const std::pair<std::string, int> wrong[] = {
        {"F 3\nV 2 0 0 0\n", 2},  // vertex numbers out of order
        {"F 3\n" + square + "S 1 1 2 3 4 0 0 .9\nS 2 1 2 3 0 0 1 .9\nS 3 1 2 3 0 0 2 .9\n", 12},  // chained cmb
        {"F 3\n" + square + "V 9 1 1.5 0\nS 1 1 2 9 4 0 0 .9\n", 11},                             // concave
        {"F 3\n" + square + "S 1 1 2 3 99 0 0 .9\n", 10},
        {"F 3\n" + square + "S 1 1 2 3 4 0 0 .9\nM 2 5 6 7 8 1 0 .9\n", 11},  // the mask faces the same way as its base
        {"F 3\n" + square + "S 1 1 2 3 4 0 0 .9\nM 2 5 8 7 6 0 0 .9\n", 11},  // no base
        {"F 2\n", 1},
        {"F 3a\nS 1 R 0 0 .9\n1 2 3\n", 2},  // the file ends within a surface
    };
    for (const auto& [text, line] : wrong) {
        const ReadScene scene = read_vs3_text(text);
        const auto error = std::find_if(scene.findings.begin(), scene.findings.end(),
                                        [](const Finding& f) { return f.kind == Finding::Kind::error; });
        ASSERT_NE(error, scene.findings.end()) << text;
        EXPECT_EQ(error->line, line) << text << error->message;
    }
}

}  // namespace
}  // namespace exitance

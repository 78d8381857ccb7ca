#include "exitance/io/scenes/obj/obj.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/scene/findings.hpp"
#include "support/load_obj.hpp"

namespace exitance {
namespace {

/// Creates a folder for each test and removes it afterwards.
class ObjFiles : public testing::Test {
  protected:
    ObjFiles()
        : folder_(testing::TempDir() + "exitance-" + testing::UnitTest::GetInstance()->current_test_info()->name()) {
        std::filesystem::create_directories(folder_);
        write("m.mtl", "newmtl grey\nKd 0.5 0.4 0.3\nnewmtl light\nKd 0\nKe 10 20 30\n");
    }
    ~ObjFiles() override { std::filesystem::remove_all(folder_); }
    std::string write(const std::string& name, const std::string& text) {
        const std::string path = folder_ + "/" + name;
        EXPECT_TRUE(write_file(path, text));
        return path;
    }
    /// Loads a file with the text of a test.
    CheckedScene load(const std::string& text) { return load_scene(write("s.obj", text)); }
    std::string first_error(const std::string& text) {
        const auto scene = load(text);
        if (scene.scene) return "no error";
        const std::string where = scene.scene.error().where;
        return where.substr(where.find_last_of('/') + 1) + ": " + scene.scene.error().message;
    }

    std::string folder_;
};

const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ObjFiles, ReflectanceIsKeptAndRadianceBecomesExitance) {
    const auto s = load("mtllib m.mtl\n" + points + "g floor\nusemtl grey\nf 1 2 3 4\nusemtl light\nf 4 3 2 1\n");
    ASSERT_TRUE(s.scene);
    EXPECT_TRUE(s.findings.empty());
    ASSERT_EQ(s.scene->surfaces().size(), 2u);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[0], 0.5);
    EXPECT_DOUBLE_EQ(s.scene->material(SurfaceId(1)).exitance[0], 10 * pi);
    EXPECT_EQ(s.scene->emitters(), std::vector<SurfaceId>{SurfaceId(1)});
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(0)].line, 8);
    EXPECT_EQ(s.scene->groups()[s.scene->surfaces()[SurfaceId(1)].group], "floor");
}

TEST_F(ObjFiles, SlashesCommentsLineEndsContinuedLinesAndRelativeIndicesAreRead) {
    const auto s = load(
        "# c\r\nmtllib m.mtl # here\r\nv 0 0 0\r\nv +1 0 0 1.0\r\nv 1 1e0 0\r\nv 0 \\\r\n 1 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
        "usemtl grey\r\nf 1/1/1 2//1 \\\r\n 3/1 4\r\nusemtl light\r\nf -1 -2 -3 -4");
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->surfaces().size(), 2u);
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(0)].line, 11);
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(0)].area, 1);
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(1)].line, 14);
}

TEST_F(ObjFiles, SeveralLibrariesAndNamesWithBlanksAreFound) {
    write("b.mtl", "newmtl two words#1\nKd 0.1\n");
    write("with blank.mtl", "newmtl third\nKd 0.2 0.2 0.2\n");
    const auto s = load("mtllib m.mtl b.mtl\nmtllib with blank.mtl\n" + points +
                        "usemtl two words#1\nf 1 2 3\nusemtl third\nf 1 3 4\nusemtl light\nf 4 3 2 1\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[2], 0.1);
    EXPECT_EQ(s.scene->material(SurfaceId(1)).reflectance[2], 0.2);
}

TEST_F(ObjFiles, EveryErrorNamesItsFileAndLine) {
    const std::string head = "mtllib m.mtl\nusemtl light\n" + points;
    EXPECT_EQ(first_error(head + "v 1 2,5 0\nf 1 2 3\n"), "s.obj:7: coordinate '2,5' is not a number");
    EXPECT_EQ(first_error(head + "v 1 nan 0\nf 1 2 3\n"), "s.obj:7: coordinate 'nan' is not a finite number");
    EXPECT_EQ(first_error(head + "v 1 1e999 0\nf 1 2 3\n"), "s.obj:7: coordinate '1e999' is not a finite number");
    EXPECT_EQ(first_error(head + "v 1 2\nf 1 2 3\n"), "s.obj:7: vertex has 2 coordinates, not three");
    EXPECT_EQ(first_error(head + "f 1 2 0\n"), "s.obj:7: face names vertex 0");
    EXPECT_EQ(first_error(head + "f 1 2 -5\n"), "s.obj:7: face names vertex -5, but only 4 vertices are above it");
    EXPECT_EQ(first_error(head + "f 1 2 5\n"), "s.obj:7: face names vertex 5 of 4");
    EXPECT_EQ(first_error(head + "f 1 2 x\n"), "s.obj:7: face names 'x', which is not a vertex number");
    EXPECT_EQ(first_error(head + "f 1 2 99999999999999999999\n"),
              "s.obj:7: face names '99999999999999999999', which is not a vertex number");
    EXPECT_EQ(first_error(""), "s.obj:1: there are no polygons");
}

TEST_F(ObjFiles, WithoutAMaterialFileEverythingIsGreyWithAWarning) {
    const auto s = load("usemtl grey\n" + points + "f 1 2 3\nusemtl red\nf 1 3 4\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[0], 0.5);
    EXPECT_EQ(std::count_if(s.findings.begin(), s.findings.end(),
                            [](const Finding& f) { return f.kind == Finding::Kind::repair; }),
              1);
    EXPECT_NE(
        first_error("mtllib none.mtl\nusemtl grey\n" + points + "f 1 2 3\n").find("s.obj:1: material file 'none.mtl'"),
        std::string::npos);
}

TEST_F(ObjFiles, AMissingMaterialFileIsRepairedWhereEmissionDoesNotMatter) {
    const std::vector<std::string> files{write("s.obj", "mtllib none.mtl\nusemtl grey\n" + points + "f 1 2 3\n")};
    LoadOptions options;
    EXPECT_FALSE(load_scene(files, options).scene);
    options.needs_light = false;
    const LoadedScene scene = load_scene(files, options);
    ASSERT_TRUE(scene.scene);
    EXPECT_EQ(scene.scene->material(SurfaceId(0)).reflectance[0], 0.5);
}

TEST_F(ObjFiles, UnknownMaterialsReflectOneHalfAndAreReportedOnce) {
    const auto s =
        load("mtllib m.mtl\n" + points + "usemtl light\nf 1 2 3\nusemtl red\nf 1 3 4\nusemtl blue\nf 4 3 2 1\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->material(SurfaceId(1)).reflectance[0], 0.5);
    ASSERT_EQ(s.findings.size(), 1u);
    EXPECT_EQ(s.findings[0].kind, Finding::Kind::repair) << "an error under --strict";
    EXPECT_NE(s.findings[0].message.find("material 'red' and 1 more are in no material file"), std::string::npos);
}

TEST_F(ObjFiles, AMissingMaterialFileIsAnErrorOnlyIfNothingEmits) {
    const std::string text = "mtllib none.mtl m.mtl\n" + points + "usemtl grey\nf 1 2 3\n";
    const auto s = load(text + "usemtl light\nf 1 3 4\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[0], 0.5);
    write("s.obj", "mtllib none.mtl\nusemtl grey\n" + points + "f 1 2 3\n");
    LoadOptions under_sky;
    under_sky.sky.emplace();
    under_sky.sky->in_watts.domes.push_back({{}, Spectrum(1.0)});
    const std::string path = folder_ + "/s.obj";
    EXPECT_TRUE(load_scene(std::span(&path, 1), under_sky).scene);
    EXPECT_FALSE(load_scene(path).scene);
}

TEST_F(ObjFiles, ASceneOfGlassOnlyNamesItsMaterials) {
    write("g.mtl", "newmtl water\nKd 0 0 0\nd 0.1\n");
    EXPECT_EQ(first_error("mtllib g.mtl\nusemtl water\n" + points + "f 1 2 3\nf 1 3 4\n")
                  .find("s.obj: all 2 faces are panes of clear glass by material 'water' ("),
              0u);
}

TEST_F(ObjFiles, UnitsAndAxesAreThoseOfTheOptions) {
    const std::string path = write("s.obj", "mtllib m.mtl\n" + points + "usemtl light\nf 1 2 3 4\n");
    LoadOptions options;
    options.metres_per_unit = 0.0254, options.y_is_up = true;
    const LoadedScene s = load_scene(std::span(&path, 1), options);
    ASSERT_TRUE(s.scene);
    EXPECT_NEAR(s.scene->surfaces()[SurfaceId(0)].area, 0.0254 * 0.0254, 1e-15);
    EXPECT_EQ(s.scene->surfaces()[SurfaceId(0)].normal, (Normal{0, -1, 0})) << "z of the file is -y";
    const std::string glb = write("s.glb", "glTF");
    EXPECT_EQ(load_scene(std::span(&glb, 1), options).scene.error().code, ErrorCode::usage);
    const std::string rad = write("s.rad", "void plastic a 0 0 5 .5 .5 .5 0 0\n");
    EXPECT_EQ(load_scene(std::span(&rad, 1), options).scene.error().where, "--up");
}

TEST_F(ObjFiles, PicturesAreFoundByPathsOfOtherSystems) {
    Image grey(1, 1);
    grey.rgb = {188, 188, 188};
    ASSERT_TRUE(write_png(folder_ + "/Brick.PNG", grey, {}));
    for (const std::string name : {"brick.png", "C:\\Users\\me\\textures\\brick.png", ".\\Brick.png"}) {
        write("w.mtl", "newmtl wall\nKd 1 1 1\nmap_Kd " + name + "\n");
        const auto s = load("mtllib w.mtl\nusemtl wall\n" + points + "f 1 2 3 4\n");
        ASSERT_TRUE(s.scene);
        EXPECT_NEAR(s.scene->material(SurfaceId(0)).reflectance[0], bands == 1 ? 0.48 : 0.475, 0.03) << name;
    }
}

TEST_F(ObjFiles, EveryMaterialErrorNamesMaterialBandValueAndLine) {
    const auto error_of_material = [&](const std::string& lines) {
        write("bad.mtl", "newmtl red\n" + lines);
        return first_error("mtllib bad.mtl\nusemtl red\n" + points + "f 1 2 3\n");
    };
    EXPECT_EQ(error_of_material("Kd 2 1 1\n"), "bad.mtl:2: material 'red': reflectance Kd of red is 2, not in [0, 1)");
    EXPECT_EQ(error_of_material("\nKd 0.5 0.5 1.2\n"),
              "bad.mtl:3: material 'red': reflectance Kd of blue is 1.2, not in [0, 1)");
    EXPECT_EQ(error_of_material("Kd -0.5\n"),
              "bad.mtl:2: material 'red': reflectance Kd of all bands is -0.5, not in [0, 1)");
    EXPECT_EQ(error_of_material("Kd 0\nKe 0 -1 0\n"), "bad.mtl:3: material 'red': emission Ke of green is -1, below 0");
    EXPECT_EQ(error_of_material("Kd 0\nKe 0 inf 0\n"), "bad.mtl:3: material 'red': 'inf' in Ke is not a finite number");
    EXPECT_EQ(error_of_material("Kd 0 0\n"), "bad.mtl:2: material 'red': Kd has 2 values");
    EXPECT_EQ(error_of_material("Kd\n"), "bad.mtl:2: material 'red': Kd has 0 values");
    EXPECT_EQ(error_of_material("Kd spectral x.rfl\n"), "bad.mtl:2: 'Kd spectral' of material 'red' is not supported");
    EXPECT_EQ(error_of_material("Kd 0.5\nnewmtl\nKd 0.5\n"), "bad.mtl:3: 'newmtl' without a name");
}

TEST_F(ObjFiles, AllErrorsAreReportedTogetherWithThoseOfShapes) {
    const auto s = load("mtllib m.mtl\nusemtl light\n" + points + "v x 0 0\nf 1 2 0\nf 1 3 2 4\nf 1 2 5\nf 1 2 3 4\n");
    ASSERT_FALSE(s.scene);
    std::vector<int> lines;
    for (const Finding& f : s.findings) lines.push_back(f.line);
    EXPECT_EQ(lines, (std::vector<int>{7, 8, 9}));  // the face in line 10 uses a vertex whose error was reported
}

TEST_F(ObjFiles, FacesWithoutMaterialGetANamedDefaultAndAWarning) {
    const auto s = load(points + "f 1 2 3 4\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).name, "default");
    ASSERT_EQ(s.findings.size(), 2u);  // the second warning: nothing emits
    EXPECT_EQ(s.findings[0].kind, Finding::Kind::warning);
}

TEST_F(ObjFiles, MissingFilesAndUnknownFormatsAreErrors) {
    EXPECT_EQ(load_scene(folder_ + "/none.obj").scene.error().code, ErrorCode::cannot_read);
    EXPECT_EQ(load_scene(folder_).scene.error().code, ErrorCode::bad_input);
    EXPECT_EQ(load_scene(write("s.stl", "solid")).scene.error().code, ErrorCode::bad_input);
    EXPECT_EQ(load_obj(folder_ + "/none.obj").error().where, folder_ + "/none.obj");
}

TEST_F(ObjFiles, TextInUtf16IsAnErrorThatNamesIt) {
    const std::string wide("\xff\xfev\0 \0\x31\0", 8);
    EXPECT_EQ(first_error(wide), "s.obj: is text in UTF-16");
}

TEST_F(ObjFiles, MessagesShowNamesAsValidText) {
    const auto said = [&](const std::string& name) {
        const auto s = load("mtllib m.mtl\n" + points + "usemtl light\nf 1 2 3\nusemtl " + name + "\nf 1 3 4\n");
        return s.findings.size() == 1 ? s.findings[0].message.substr(0, s.findings[0].message.find(':')) : "";
    };
    EXPECT_EQ(said("w\xc3\xa4nde"), "material 'w\xc3\xa4nde' is in no material file");
    EXPECT_EQ(said("\xff\x01\xc3_"), "material '???_' is in no material file");
    EXPECT_LT(first_error("v " + std::string(100000, 'x') + " 0 0\n").size(), 120u);
}

TEST_F(ObjFiles, ArbitraryBytesDoNotCrashTheReader) {
    std::string bytes;
    for (int i = 0; i < 4096; ++i) bytes += static_cast<char>(i * 7919 >> 3);
    EXPECT_FALSE(load(bytes).scene);
    EXPECT_FALSE(load(std::string(1000, '\\')).scene);
    EXPECT_FALSE(load("f\nf 1\nv\nmtllib\nusemtl\nf 1 2 3 \\").scene);
}

TEST_F(ObjFiles, GlassBecomesPanesAndTexturesTheirMean) {
    write("g.mtl",
          "newmtl floor\nKd 0.5 0.4 0.3\nmap_Kd -s 1 1 1 no.png\nnewmtl clear\nKd 1 1 1\nd 0.12\n"
          "newmtl tinted\nKd 0 0 0\nTf 0.8 0.7 0.6\nillum 4\nnewmtl curtain\nKd 0.5 0.5 0.5\nd 0.6\n");
    const auto s = load("mtllib g.mtl\n" + points +
                        "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl floor\nf 1 2 3 4\nusemtl clear\nf 5 6 7 8\n"
                        "usemtl tinted\nf 5 6 7\nusemtl curtain\nf 1 2 6 5\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 2u);
    ASSERT_EQ(s.scene->panes().size(), 2u);
    EXPECT_NEAR(s.scene->panes()[0].transmission(1)[0], 0.88, 1e-9);
    EXPECT_NEAR(s.scene->panes()[1].transmission(1)[bands - 1], bands == 3 ? 0.6 : 0.7, 0.1);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[0], 0.5) << "the texture is not there";
    const auto said = [&](const std::string& what) {
        return std::count_if(s.findings.begin(), s.findings.end(),
                             [&](const Finding& f) { return f.message.find(what) != f.message.npos; });
    };
    EXPECT_EQ(said("'no.png'"), 1);
    EXPECT_EQ(said("panes of clear glass"), 1);
    EXPECT_EQ(said("no more than half"), 1);
}

TEST_F(ObjFiles, FacesTakeTheirPartOfAnAtlas) {
    Image atlas(64, 64);  // picture whose left half is white and whose right half is black
    for (int y = 0; y < 64; ++y) std::fill_n(atlas.at(0, y), 3 * 32, std::uint8_t(255));
    ASSERT_TRUE(write_png(folder_ + "/a.png", atlas, {}));
    write("t.mtl", "newmtl atlas\nKd 0.8 0.8 0.8\nmap_Kd a.png\nnewmtl lamp\nKd 0\nKe 2 2 2\nmap_Ke a.png\n");
    const auto s = load("mtllib t.mtl\n" + points +
                        "v 2 0 0\nv 2 1 0\nv 3 0 0\nv 3 1 0\nvt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1\n"
                        "usemtl atlas\nf 1/1 2/2 3/3 4/4\nf 2/2 5/5 6/6 3/3\nf 5 7 8 6\n"
                        "usemtl lamp\nf 4/4 3/3 2/2 1/1\n");
    ASSERT_TRUE(s.scene);
    ASSERT_EQ(s.scene->surfaces().size(), 4u);
    EXPECT_NEAR(s.scene->material(SurfaceId(0)).reflectance[0], 0.8, 1e-9);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).name, "atlas #e7e7e7");
    EXPECT_EQ(s.scene->material(SurfaceId(1)).reflectance[0], 0);
    EXPECT_NEAR(s.scene->material(SurfaceId(2)).reflectance[0], 0.4, 1e-9) << "without places: the mean";
    EXPECT_NEAR(s.scene->material(SurfaceId(3)).exitance[0], 2 * pi, 1e-9);
    EXPECT_EQ(std::count_if(s.findings.begin(), s.findings.end(),
                            [](const Finding& f) { return f.message.find("texture") != f.message.npos; }),
              1);
}

TEST_F(ObjFiles, AMapOfOpacityMakesHoles) {
    Image mask(64, 64);  // mask that is white in its left quarter
    for (int y = 0; y < 64; ++y) std::fill_n(mask.at(0, y), 3 * 16, std::uint8_t(255));
    ASSERT_TRUE(write_png(folder_ + "/mask.png", mask, {}));
    write("h.mtl", "newmtl fence\nKd 0.5 0.5 0.5\nmap_d mask.png\nnewmtl bad\nKd 0.5\nmap_d no.png\n");
    const auto s = load("mtllib h.mtl\n" + points +
                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl fence\nf 1/1 2/2 3/3 4/4\nv 0 0 1\nusemtl bad\n"
                        "f 1/1 2/2 5/3\n");
    ASSERT_TRUE(s.scene);
    EXPECT_NEAR(s.scene->surfaces()[SurfaceId(0)].area, 0.25, 1e-9);
    EXPECT_EQ(s.scene->material(SurfaceId(0)).reflectance[0], 0.5);
    EXPECT_TRUE(std::any_of(s.findings.begin(), s.findings.end(),
                            [](const Finding& f) { return f.message.find("its faces are opaque") != f.message.npos; }));
}

}  // namespace
}  // namespace exitance

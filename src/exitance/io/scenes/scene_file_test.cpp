#include "exitance/io/scenes/scene_file.hpp"
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/sky_words.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Expected result of reading a hard or malformed file.
struct Expected {
    std::string file;
    std::size_t surfaces;  ///< Expected number of surfaces; 0: the file is rejected.
    std::size_t regions;
    std::vector<std::string> said;  ///< Findings: "E x.obj:3" is an error in line 3, W a warning, R a repair.
};

const std::vector<Expected> expectations = {
    {"t_vertices", 11, 3, {}},
    {"nonplanar_1e-6", 17, 2, {"R nonplanar_1e-6.obj:35"}},
    {"nonplanar_5cm", 3, 3, {"R nonplanar_5cm.obj:14"}},
    {"box_on_floor", 8, 8, {}},
    {"coplanar_touching", 21, 14, {}},
    {"coplanar_duplicate", 2, 2, {"R coplanar_duplicate.obj:20"}},
    {"slivers", 6, 3, {}},
    {"interpenetrating", 20, 20, {}},
    {"coords_1e6", 8, 8, {}},
    {"scale_1e-4", 8, 8, {}},
    {"scale_1e6", 8, 8, {}},
    {"aligned_edges", 4, 4, {}},
    {"edge_in_receiver", 5, 5, {}},
    {"light_edge_on_wall", 4, 4, {}},
    {"zero_area_face", 2, 2, {"R zero_area_face.obj:13"}},
    {"duplicate_vertices", 2, 2, {"R duplicate_vertices.obj:14"}},
    {"face_2_vertices", 2, 2, {"R face_2_vertices.obj:13"}},
    {"repeated_index", 2, 2, {"R repeated_index.obj:12"}},
    {"self_intersecting", 3, 3, {"R self_intersecting.obj:12"}},
    {"nan_coordinate", 0, 0, {"E nan_coordinate.obj:4"}},
    {"inf_coordinate", 0, 0, {"E inf_coordinate.obj:4"}},
    {"bad_number", 0, 0, {"E bad_number.obj:4"}},
    {"index_out_of_range", 0, 0, {"E index_out_of_range.obj:12"}},
    {"index_zero", 0, 0, {"E index_zero.obj:12"}},
    {"negative_index", 2, 2, {}},
    {"slashes_and_comments", 2, 2, {}},
    {"missing_mtl", 0, 0, {"E missing_mtl.obj:1"}},
    {"unknown_material", 2, 2, {"R unknown_material.obj:11"}},
    {"no_material", 2, 2, {"W no_material.obj:10"}},
    {"reflectance_1", 2, 2, {"R reflectance_1.mtl:2"}},
    {"reflectance_above_1", 0, 0, {"E reflectance_above_1.mtl:2"}},
    {"reflectance_negative", 0, 0, {"E reflectance_negative.mtl:2"}},
    {"emission_negative", 0, 0, {"E emission_negative.mtl:5"}},
    {"emission_nan", 0, 0, {"E emission_nan.mtl:5"}},
    {"no_light", 1, 1, {"W no_light.obj:12"}},
    {"empty", 0, 0, {"E empty.obj:1"}},
    {"truncated", 2, 2, {}},
};

std::string said(const Finding& f) {
    const char* kind = f.kind == Finding::Kind::error ? "E " : f.kind == Finding::Kind::warning ? "W " : "R ";
    return kind + std::filesystem::path(f.file).filename().string() + ":" + std::to_string(f.line);
}

TEST(SceneFile, HardAndMalformedFilesAreAcceptedRepairedOrRejected) {
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "scenes" / "degenerate";
    for (const Expected& e : expectations) {
        const std::filesystem::path path = folder / (e.file + ".obj");
        const CheckedScene checked = load_scene(path.string());
        EXPECT_EQ(bool(checked.scene), e.surfaces > 0) << e.file;
        std::vector<std::string> findings;
        for (const Finding& f : checked.findings) findings.push_back(said(f));
        EXPECT_EQ(findings, e.said) << e.file;
        if (!checked.scene) {
            EXPECT_EQ(checked.scene.error().code, ErrorCode::bad_input) << e.file;
            continue;
        }
        EXPECT_EQ(checked.scene->surfaces().size(), e.surfaces) << e.file;
        EXPECT_EQ(checked.scene->regions().size(), e.regions) << e.file;
    }
}

TEST(SceneFile, StrictReadingTurnsRepairsIntoErrors) {
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "scenes" / "degenerate";
    for (const char* file : {"nonplanar_5cm.obj", "reflectance_1.obj", "zero_area_face.obj"}) {
        const CheckedScene checked = load_scene((folder / file).string(), Faults::refuse);
        ASSERT_FALSE(checked.scene) << file;
        EXPECT_EQ(checked.scene.error().code, ErrorCode::bad_input);
        EXPECT_FALSE(checked.findings.empty());
    }
}

TEST(SceneFile, EveryPublishedSceneIsAccepted) {
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "scenes";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".obj") continue;
        const CheckedScene checked = load_scene(entry.path().string());
        ASSERT_TRUE(checked.scene) << checked.scene.error().where << ": " << checked.scene.error().message;
        double faces = 0, regions = 0;
        for (const Surface& s : checked.scene->surfaces()) faces += s.area;
        for (const Region& r : checked.scene->regions()) regions += r.area;
        EXPECT_NEAR(regions, faces, 1e-9 * faces) << entry.path();  // the corners of bent faces are moved
    }
}

TEST(SceneFile, WebPagesAndPointersInPlaceOfScenesAreNamed) {
    const TemporaryFolder folder;
    const auto said = [&](const std::string& name, const std::string& text) {
        EXPECT_TRUE(write_file(folder / name, text));
        const CheckedScene scene = load_scene(folder / name);
        return scene.scene ? std::string("no error") : scene.scene.error().message;
    };
    EXPECT_EQ(said("a.glb", "\n\n\n<!DOCTYPE html>\n<html>"), "holds a web page in place of a scene");
    EXPECT_EQ(said("a.obj", "<HTML><body>"), "holds a web page in place of a scene");
    EXPECT_EQ(said("a.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n"),
              "holds a pointer of Git LFS in place of a scene");
    EXPECT_EQ(said("empty.obj", "").find("in place of"), std::string::npos);
}

TEST(SceneFile, ASkyInLumensMakesTheSceneOneInLumens) {
    const TemporaryFolder folder;
    const std::string square = "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n";
    for (const bool has_lamp : {false, true}) {
        ASSERT_TRUE(
            write_file(folder / "m.mtl", has_lamp ? "newmtl grey\nKe 1 1 1\n" : "newmtl grey\nKd 0.5 0.5 0.5\n"));
        ASSERT_TRUE(write_file(folder / "s.obj", "mtllib m.mtl\nusemtl grey\n" + square));
        for (const std::string efficacy : {"", ",efficacy_diffuse=110"}) {
            Result<ChosenSky> sky = parse_sky("overcast,dhi=100" + efficacy, nullptr);
            ASSERT_TRUE(sky) << sky.error().message;
            LoadOptions load;
            load.sky = std::move(*sky);
            const std::vector<std::string> paths{folder / "s.obj"};
            const LoadedScene scene = load_scene(paths, load);
            ASSERT_TRUE(scene.scene);
            EXPECT_EQ(scene.scene->is_photometric(), !efficacy.empty());
            EXPECT_EQ(scene.scene->distant().domes[0].irradiance[0], efficacy.empty() ? 100 : 11000);
            const bool warns = std::any_of(scene.findings.begin(), scene.findings.end(), [](const Finding& f) {
                return f.message.find("sky is in lumens") != std::string::npos;
            });
            EXPECT_EQ(warns, has_lamp && !efficacy.empty());
        }
    }
}

}  // namespace
}  // namespace exitance

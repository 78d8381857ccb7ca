#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/small_scene.hpp"

namespace exitance::test {

TEST(ProgramBake, WritesMapsAManifestAndAModel) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", out = folder / "new/maps";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished run = run_program({"bake", solution, "-o", out, "--density", "6"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("texels"), std::string::npos);
    const std::string manifest = read_text(out + "/lightmaps.json"), model = read_text(out + "/scene.glb");
    for (const std::string key : {"version", "quantity", "unit", "maps", "file", "width", "height", "charts", "surface",
                                  "map", "x", "y", "origin", "du", "dv", "normal"})
        EXPECT_NE(manifest.find("\"" + key + "\": "), std::string::npos) << key;
    EXPECT_NE(manifest.find("\"surface\": 6"), std::string::npos);
    EXPECT_NE(model.find("TEXCOORD_1"), std::string::npos);
    EXPECT_NE(model.find("\"emissiveTexture\":{\"index\":0,\"texCoord\":1}"), std::string::npos);
    EXPECT_GT(std::filesystem::file_size(out + "/lightmap_0.png"), 100u);
    const auto single = std::filesystem::file_size(out + "/lightmap_0.exr");

    const Finished again = run_program(
        {"bake", solution, "-o", out, "--density", "6", "--half", "--unlit", "--quantity", "radiosity", "-q"});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_LT(std::filesystem::file_size(out + "/lightmap_0.exr"), 0.7 * static_cast<double>(single));
    EXPECT_NE(read_text(out + "/scene.glb").find("\"baseColorTexture\":{\"index\":0,\"texCoord\":1}"),
              std::string::npos);
    EXPECT_NE(read_text(out + "/lightmaps.json").find("\"quantity\": \"radiosity\""), std::string::npos);

    ASSERT_EQ(run_program({"bake", solution, "-o", out, "--density", "6", "--moz-lightmap", "-q"}).status, 0);
    EXPECT_NE(read_text(out + "/scene.glb").find("\"MOZ_lightmap\":{\"index\":0"), std::string::npos);
}

TEST(ProgramBake, LightGroupsHaveSeparateMaps) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5", out = folder / "maps";
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished none = run_program({"bake", solution, "-o", out, "--density", "6", "--light-groups"});
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("--light-groups"), std::string::npos) << none.err;
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "--light-groups", "-q"}).status, 0);
    const Finished run = run_program({"bake", solution, "-o", out, "--density", "6", "--light-groups"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(read_text(out + "/lightmaps.json").find("\"files\": [\"lightmap_0_0.exr\"]"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(out + "/lightmap_0_0.exr"));
    EXPECT_TRUE(std::filesystem::exists(out + "/lightmap_0_0.png"));
}

/// Gives every face of an OBJ file the same square of texture coordinates.
void add_places(const std::string& file) {
    std::istringstream lines(read_text(file));
    std::string out = "vt 0.1 0.1\nvt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\n";
    for (std::string line; std::getline(lines, line);) {
        int a = 0, b = 0, c = 0, d = 0;
        if (std::sscanf(line.c_str(), "f %d %d %d %d", &a, &b, &c, &d) == 4)
            line = "f " + std::to_string(a) + "/1 " + std::to_string(b) + "/2 " + std::to_string(c) + "/3 " +
                   std::to_string(d) + "/4";
        out += line + "\n";
    }
    write_text(file, out);
}

TEST(ProgramBake, TextureCoordinatesOfTheFileGiveAMapPerObject) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5", out = folder / "maps";
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished none = run_program({"bake", solution, "-o", out, "--uv", "own"});
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("unwrap"), std::string::npos) << none.err;
    EXPECT_FALSE(std::filesystem::exists(out));

    add_places(scene);
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "--light-groups", "-q"}).status, 0);
    const std::string charts = folder / "charts.png";
    const Finished run = run_program({"bake", solution, "-o", out, "--uv", "own", "--size", "24x16", "--charts", charts,
                                      "--light-groups", "--quantity", "radiosity"});
    ASSERT_EQ(run.status, 0) << run.err;
    // Floor, ceiling, walls and lamp overlap each other, and the four walls among themselves.
    EXPECT_NE(run.err.find("8 triangles overlap"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("'walls' (8)"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("a map of its own"), std::string::npos) << run.err;
    const std::string manifest = read_text(out + "/lightmaps.json");
    for (const std::string text :
         {"\"version\": 1", "\"set\": \"vt\"", "\"quantity\": \"radiosity\"", "\"name\": \"walls\", \"map\": 2",
          "\"overlapping\": 8", "\"width\": 24, \"height\": 16", "\"files\": [\"lightmap_0_0.exr\""})
        EXPECT_NE(manifest.find(text), std::string::npos) << text << " is not in " << manifest;
    for (int m = 0; m < 4; ++m) {
        EXPECT_TRUE(std::filesystem::exists(out + "/lightmap_" + std::to_string(m) + ".exr"));
        EXPECT_TRUE(std::filesystem::exists(folder / ("charts_" + std::to_string(m) + ".png")));
    }
    EXPECT_FALSE(std::filesystem::exists(out + "/scene.glb"));

    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--size", "24x16"}).status, 2);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--uv", "own", "--size", "9x9", "--density", "5"}).status, 2);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--uv", "own", "--unlit"}).status, 2);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--uv", "TEXCOORD_1"}).status, 2);
    std::filesystem::remove(scene);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--uv", "own"}).status, 3);
}

/// The model that is written with its coordinates can be solved and baked into them without warnings.
TEST(ProgramBake, UnwrapsAModelWithoutCoordinates) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", out = folder / "maps";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished run = run_program({"bake", solution, "-o", out, "--uv", "unwrap", "--size", "64x64", "--unlit"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("charts cover"), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find("warning"), std::string::npos) << run.err;
    const std::string manifest = read_text(out + "/lightmaps.json");
    for (const std::string text : {"\"model\": \"scene.glb\"", "\"unwrapped\": {\"charts\": ", "\"filled\": ",
                                   "\"set\": \"TEXCOORD_1\"", "\"overlapping\": 0", "\"mirrored\": 0"})
        EXPECT_NE(manifest.find(text), std::string::npos) << text << " is not in " << manifest;
    EXPECT_NE(read_text(out + "/scene.glb").find("\"baseColorTexture\":{\"index\":0,\"texCoord\":1}"),
              std::string::npos);

    const std::string again = folder / "again.h5";
    ASSERT_EQ(run_program({"solve", out + "/scene.obj", "-o", again, "--error", "0.1", "-q"}).status, 0);
    const Finished second = run_program({"bake", again, "-o", folder / "again", "--uv", "vt", "--size", "64x64"});
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_EQ(second.err.find("warning"), std::string::npos) << second.err;
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--uv", "unwrap", "--size", "8x8"}).status, 2);
}

TEST(ProgramBake, RejectsInvalidOptions) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const std::string out = folder / "maps";
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--unlit", "--moz-lightmap"}).status, 2);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--density", "0"}).status, 2);
    EXPECT_EQ(run_program({"bake", solution, "-o", out, "--padding", "1000"}).status, 2);
    const Finished large = run_program({"bake", solution, "-o", out, "--density", "1e7"});
    EXPECT_EQ(large.status, 2);
    EXPECT_NE(large.err.find("--density"), std::string::npos) << large.err;
    EXPECT_FALSE(std::filesystem::exists(out));
    // A file has the name of the output folder.
    std::ofstream(folder / "taken") << "a file";
    EXPECT_EQ(run_program({"bake", solution, "-o", folder / "taken", "--density", "4"}).status, 5);
    EXPECT_EQ(run_program({"bake", folder / "absent.h5", "-o", out}).status, 3);
}

}  // namespace exitance::test

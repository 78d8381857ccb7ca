#include "exitance/io/scenes/obj/obj_writer.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/samples/generate.hpp"
#include "support/load_obj.hpp"
#include "support/places.hpp"

namespace exitance {
namespace {

/// Path of a published test scene.
std::filesystem::path published(const std::string& file) {
    return std::filesystem::path(test::data_folder()) / "scenes" / file;
}

TEST(ObjWriter, ScenesAreReadBackAsWritten) {
    const std::string path = testing::TempDir() + "exitance-written.obj";
    for (const SceneFamily& family : scene_families()) {
        const auto scene = generate_scene(family.name, {});
        ASSERT_TRUE(scene);
        ASSERT_TRUE(write_obj(*scene, path));
        const auto read = load_obj(path);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->points, scene->points) << family.name;
        ASSERT_EQ(read->faces.size(), scene->faces.size());
        for (std::size_t f = 0; f < scene->faces.size(); ++f) {
            const auto &a = read->faces[f], &b = scene->faces[f];
            EXPECT_EQ(a.corners, b.corners);
            EXPECT_EQ(read->groups[a.group], scene->groups[b.group]);
            EXPECT_EQ(read->materials[a.material].name, scene->materials[b.material].name);
        }
        for (std::size_t m = 0; m < scene->materials.size(); ++m) {
            EXPECT_EQ(read->materials[m].reflectance, scene->materials[m].reflectance);
            for (std::size_t b = 0; b < bands; ++b)
                EXPECT_DOUBLE_EQ(read->materials[m].exitance[b], scene->materials[m].exitance[b]);
        }
    }
    std::filesystem::remove(path);
    std::filesystem::remove(testing::TempDir() + "exitance-written.mtl");
}

TEST(ObjWriter, AMissingFolderIsAnError) {
    const auto written = write_obj(SceneDescription{}, testing::TempDir() + "no/such/folder/x.obj");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cannot_write);
}

TEST(SceneFamilies, AgreeWithThePublishedScenes) {
    using Parameters = std::map<std::string, std::string>;
    const std::vector<std::pair<std::string, Parameters>> scenes = {
        {"blocker", {{"h", "0.2"}}},
        {"tube", {{"rho", "0.9"}}},
        {"furnace", {{"rho", "0.3"}}},
        {"complex", {{"m", "1"}}},
        {"complex", {{"m", "20"}}},
        {"flat", {{"lights", "4"}}},
        {"boxes", {{"lights", "2"}}},
        {"table", {}},
        {"chair", {{"lights", "3"}}},
        {"float", {}},
        {"spiral", {}},
        {"gcr1", {}},
        {"gcr2", {}},
        {"cornell", {}},
        {"office", {{"nx", "2"}, {"ny", "1"}, {"nfurn", "2"}, {"books", "3"}}}};
    for (const auto& [family, parameters] : scenes) {
        const auto made = generate_scene(family, parameters);
        ASSERT_TRUE(made);
        const auto read = load_obj(published(made->file).string());
        ASSERT_TRUE(read) << read.error().message;
        ASSERT_EQ(read->faces.size(), made->faces.size()) << made->file;
        for (std::size_t f = 0; f < made->faces.size(); ++f) {
            ASSERT_EQ(read->faces[f].corners.size(), made->faces[f].corners.size());
            for (std::size_t c = 0; c < made->faces[f].corners.size(); ++c) {
                const Point p = read->points[read->faces[f].corners[c]], q = made->points[made->faces[f].corners[c]];
                EXPECT_LT(norm(p - q), 1e-9) << made->file;  // files have 12 digits
            }
            const Material &a = read->materials[read->faces[f].material], &b = made->materials[made->faces[f].material];
            EXPECT_EQ(a.name, b.name);
            for (std::size_t k = 0; k < bands; ++k) {
                EXPECT_EQ(a.reflectance[k], b.reflectance[k]);
                EXPECT_NEAR(a.exitance[k], b.exitance[k], 1e-6 * b.exitance[k]);  // files have 6 digits
            }
        }
    }
}

}  // namespace
}  // namespace exitance

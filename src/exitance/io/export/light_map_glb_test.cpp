#include <gtest/gtest.h>

#include "exitance/io/export/light_map_files.hpp"
#include "exitance/io/export/reflected_maps.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/io/scenes/gltf/gltf.hpp"
#include "exitance/io/scenes/gltf/gltf_model.hpp"
#include "support/checked_scene.hpp"
#include "support/gltf_text.hpp"
#include "support/sample_solution.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// A floor of 2 x 1 m with a picture of 2 x 1 pixels, which makes the left half white and the right half black, and
/// with two sets of texture coordinates; a lamp above it.
std::string write_textured_floor(const TemporaryFolder& folder) {
    Image picture(2, 1);
    picture.rgb = {255, 255, 255, 0, 0, 0};
    const Result<std::string> png = encode_png(picture, {});
    EXI_CHECK(static_cast<bool>(png));
    test::GltfText text;
    const auto places = [&](const std::vector<float>& numbers) {
        return std::to_string(text.add(numbers.data(), numbers.size() * 4, 5126, "VEC2", numbers.size() / 2));
    };
    const std::string floor = std::to_string(text.positions({{0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, 0}}));
    const std::string lamp = std::to_string(text.positions({{0, 2, 0}, {2, 2, 0}, {2, 2, 1}, {0, 2, 1}}));
    const std::string first = places({0, 0, 0, 1, 1, 1, 1, 0}), second = places({0.5, 0, 0.5, 1, 1, 1, 1, 0});
    const std::string index = std::to_string(text.indices({0, 1, 2, 0, 2, 3}));
    const int image = text.add_view(png->data(), png->size());
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":)" + floor + R"(,"TEXCOORD_0":)" + first +
                  R"(,"TEXCOORD_1":)" + second + R"(},"indices":)" + index +
                  R"(,"material":0}]},{"primitives":[{"attributes":{"POSITION":)" + lamp + R"(},"indices":)" + index +
                  R"(,"material":1}]})";
    text.nodes = R"({"mesh":0},{"mesh":1})";
    text.materials = R"({"name":"halves","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}},)"
                     R"({"name":"lamp","emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"metallicFactor":0}})";
    text.textures = R"({"source":0,"sampler":0})";
    text.images = R"({"bufferView":)" + std::to_string(image) + R"(,"mimeType":"image/png"})";
    text.more = R"(,"samplers":[{"wrapS":33071,"wrapT":33071}])";
    const std::string path = folder / "floor.glb";
    EXI_CHECK(static_cast<bool>(write_file(path, text.glb())));
    return path;
}

Solution lit(const std::string& path) {
    Solution s = even_solution(checked_scene(read_gltf(path, 0).description), 4);
    s.direct_in_elements = true;
    return s;
}

LightMaps baked(const Solution& s) {
    Progress progress;
    const StopRequest stop;
    const RadiosityFunction light(s);
    Result<LightMaps> maps = bake_light_maps(light, {10, 2, 1024}, progress, stop);
    EXI_CHECK(static_cast<bool>(maps));
    return std::move(*maps);
}

TEST(LightMapModel, ReflectedLightFollowsTheTextureAndKeepsItsMean) {
    const TemporaryFolder folder;
    const Solution s = lit(write_textured_floor(folder));
    const std::optional<SceneTextures> textures = load_scene_textures(s.scene, s.scene.file());
    ASSERT_TRUE(textures);
    ASSERT_EQ(textures->pictures.size(), 1u);
    ASSERT_TRUE(textures->has_second_set());
    EXPECT_EQ(textures->coats[MaterialId(0)].wrap_s, 33071);
    const LightMaps light = baked(s), reflected = reflected_maps(s.scene, light, &*textures);
    const SurfaceId floor(0);
    ASSERT_NEAR(s.scene.materials()[MaterialId(0)].reflectance[0], 0.5, 1e-12);
    ASSERT_NEAR(s.scene.material(floor).reflectance[0], 0.75, 0.02)
        << "the triangle's own part is white by three quarters";
    // The floor's two triangles have separate colours, regions and charts.
    const auto read = [&](const LightMaps& maps, const Point& p) {
        const SurfaceId triangle(p.y > -0.5 * p.x ? 1 : 0);
        const Chart& chart = light.charts[s.scene.surfaces()[triangle].region.value];
        const LightMap& map = maps.maps[chart.map];
        const Vec2 place = chart.place(p);
        return map.at(map.index(chart.x + static_cast<int>(std::floor(place.x)),
                                chart.y + static_cast<int>(std::floor(place.y))))[0];
    };
    const auto at = [&](const Point& p) { return read(reflected, p); };
    EXPECT_NEAR(at({0.25, -0.5, 0}), 0.95 * 4, 1e-6);  // a reflectance of 1 is reduced to 0.95
    EXPECT_NEAR(at({1.75, -0.5, 0}), 0, 1e-6);
    EXPECT_NEAR(at({1.05, -0.3, 0}), 0.45 * 4, 0.05);   // interpolated between the centres of both pixels
    EXPECT_NEAR(at({-0.05, -0.5, 0}), 0.95 * 4, 1e-6);  // the value beyond the border is that at the border
    const LightMaps plain = reflected_maps(s.scene, light, nullptr);
    EXPECT_NEAR(read(plain, {0.25, -0.5, 0}), 4 * s.scene.material(floor).reflectance[0], 1e-6);
}

TEST(LightMapModel, KeepsPicturesAndBothSetsOfCoordinates) {
    const TemporaryFolder folder;
    const std::string path = write_textured_floor(folder);
    const Solution s = lit(path);
    const LightMaps light = baked(s);
    for (const LightMapMaterial kind : {LightMapMaterial::emissive, LightMapMaterial::moz_lightmap}) {
        ASSERT_TRUE(write_light_map_glb(s, light, {.material = kind, .scene_file = path}, {}, folder / "out.glb"));
        const Result<std::string> out = read_whole_file(folder / "out.glb");
        ASSERT_TRUE(out);
        EXPECT_NE(out->find("\"TEXCOORD_2\""), std::string::npos);
        EXPECT_NE(out->find("\"baseColorTexture\":{\"index\":1,\"texCoord\":0}"), std::string::npos);
        EXPECT_NE(out->find("{\"index\":0,\"texCoord\":2"), std::string::npos);
        std::vector<Finding> findings;
        const Result<GltfModel> again = load_gltf_model(folder / "out.glb", findings, true);
        ASSERT_TRUE(again);
        EXPECT_EQ(again->pictures.size(), 2u);
    }
    ASSERT_TRUE(write_light_map_glb(s, light, {}, {}, folder / "out.glb"));  // write the file without the scene's file
    const Result<std::string> out = read_whole_file(folder / "out.glb");
    EXPECT_EQ(out->find("\"TEXCOORD_2\""), std::string::npos);
    EXPECT_FALSE(load_scene_textures(s.scene, ""));
}

}  // namespace
}  // namespace exitance

#include "exitance/io/scenes/gltf/gltf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/gltf_text.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

using test::GltfText;

/// A triangle of 0.5 m^2 in glTF's floor plane (y = 0) that faces up: mesh 0, without a node.
GltfText triangle(const std::string& material = "") {
    GltfText text;
    text.positions({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    text.indices({0, 1, 2});
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"indices":1)" +
                  (material.empty() ? "" : std::string(R"(,"material":0)")) + "}]}";
    text.materials = material;
    return text;
}

class GltfFiles : public testing::Test {
  protected:
    CheckedScene load(const GltfText& text, const std::string& name = "s.glb") {
        EXPECT_TRUE(write_file(folder_ / name, text.glb()));
        return load_scene(folder_ / name);
    }
    Scene scene(const GltfText& text) {
        CheckedScene out = load(text);
        EXPECT_TRUE(out.scene) << out.scene.error().message;
        if (!out.scene) std::abort();
        return std::move(*out.scene);
    }
    std::string first_error(const GltfText& text) {
        const CheckedScene out = load(text);
        return out.scene ? "no error" : out.scene.error().message;
    }
    static std::size_t warnings(const CheckedScene& scene, const std::string& about) {
        return static_cast<std::size_t>(
            std::count_if(scene.findings.begin(), scene.findings.end(), [&](const Finding& f) {
                return f.kind == Finding::Kind::warning && f.message.find(about) != f.message.npos;
            }));
    }
    TemporaryFolder folder_;
};

}  // namespace

TEST_F(GltfFiles, ConvertYUpToZUp) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0,"name":"floor","translation":[1,2,3]})";
    const Scene s = scene(text);
    ASSERT_EQ(s.surfaces().size(), 1u);
    EXPECT_EQ(s.surfaces()[SurfaceId(0)].normal, (Normal{0, 0, 1}));
    EXPECT_EQ(s.outline(SurfaceId(0))[0], (Point{1, -3, 2}));
    EXPECT_EQ(s.outline(SurfaceId(0))[1], (Point{1, -4, 2}));
    EXPECT_EQ(s.groups()[s.surfaces()[SurfaceId(0)].group], "floor");
}

TEST_F(GltfFiles, ParentsTransformTheirChildren) {
    GltfText text = triangle();
    // The parent rotates by 90 degrees about y and scales by 2; the child moves by (1, 0, 0): (1, 0, 0) -> (0, 0, -2).
    text.nodes = R"({"children":[1],"rotation":[0,0.70710678118654757,0,0.70710678118654757],"scale":[2,2,2]},
                    {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1]})";
    const Scene s = scene(text);
    const Point p = s.outline(SurfaceId(0))[0];
    EXPECT_NEAR(norm(p - Point{0, 2, 0}), 0, 1e-12);  // tolerance: rounding of the quaternion
    EXPECT_NEAR(s.surfaces()[SurfaceId(0)].area, 2, 1e-12);
}

TEST_F(GltfFiles, AMirroredInstanceKeepsItsFrontOutside) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0},{"mesh":0,"scale":[-1,1,1],"translation":[-1,0,0]},{"mesh":0,"scale":[1,-1,1],
                    "translation":[0,3,0]})";
    const Scene s = scene(text);
    ASSERT_EQ(s.surfaces().size(), 3u);
    EXPECT_EQ(s.surfaces()[SurfaceId(1)].normal, (Normal{0, 0, 1}));
    EXPECT_EQ(s.surfaces()[SurfaceId(2)].normal, (Normal{0, 0, -1})) << "a mirrored floor is a ceiling";
}

TEST_F(GltfFiles, StripsAndFansAreTrianglesOfOneOrientation) {
    GltfText text;
    text.positions({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}});  // z varies before x: a strip over a square
    text.positions({{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}});  // a fan
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":1},"mode":6}]})";
    text.nodes = R"({"mesh":0})";
    const Scene s = scene(text);
    EXPECT_EQ(s.surfaces().size(), 4u);
    ASSERT_EQ(s.regions().size(), 2u);
    for (const Region& r : s.regions()) {
        EXPECT_EQ(r.plane.n, (Normal{0, 0, 1}));
        EXPECT_NEAR(r.area, 1, 1e-12);
    }
}

TEST_F(GltfFiles, SpecularGlossinessReflectsItsDiffuseFactor) {
    GltfText text = triangle(R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":{
        "diffuseFactor":[0.1,0.2,0.3,1],"specularFactor":[1,1,1]}}})");
    text.nodes = R"({"mesh":0})";
    const CheckedScene s = load(text);
    ASSERT_TRUE(s.scene);
    EXPECT_NEAR(s.scene->material(SurfaceId(0)).reflectance[0], bands == 1 ? 0.2 : 0.1, 1e-12);
    EXPECT_NEAR(s.scene->material(SurfaceId(0)).reflectance[bands - 1], bands == 1 ? 0.2 : 0.3, 1e-12);
    EXPECT_EQ(warnings(s, "metal"), 0u);
}

TEST_F(GltfFiles, ADoubleSidedMaterialMakesTwoSurfaces) {
    GltfText text = triangle(R"({"doubleSided":true,"pbrMetallicRoughness":{"metallicFactor":0}})");
    text.nodes = R"({"mesh":0})";
    const Scene s = scene(text);
    ASSERT_EQ(s.surfaces().size(), 2u);
    EXPECT_EQ(s.surfaces()[SurfaceId(0)].normal, -s.surfaces()[SurfaceId(1)].normal);
}

TEST_F(GltfFiles, MaterialsGiveReflectanceAndRadiance) {
    GltfText text = triangle(
        R"({"name":"lamp","pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1],"metallicFactor":0.25},
            "emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":8}}})");
    text.nodes = R"({"mesh":0})";
    const Scene s = scene(text);
    const Material& m = s.materials()[MaterialId(0)];
    EXPECT_EQ(m.name, "lamp");
    EXPECT_NEAR(m.reflectance[0], 0.6, 1e-12);
    EXPECT_NEAR(m.exitance[0], 8 * pi, 1e-12);
    if constexpr (bands == 3) {
        EXPECT_NEAR(m.reflectance[2], 0.15, 1e-12);
        EXPECT_NEAR(m.exitance[1], 4 * pi, 1e-12);
    }
}

TEST_F(GltfFiles, WhiteIsReducedAndReportedOnce) {
    GltfText text = triangle(R"({"pbrMetallicRoughness":{"metallicFactor":0}},
                                {"name":"snow","pbrMetallicRoughness":{"metallicFactor":0}})");
    text.nodes = R"({"mesh":0})";
    const CheckedScene s = load(text);
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->materials()[MaterialId(0)].reflectance, Spectrum(0.95));
    EXPECT_EQ(warnings(s, "0.95"), 1u);
}

TEST_F(GltfFiles, ATextureIsReplacedByItsMean) {
    Image image(2, 1);  // white and black: the mean of light is 1/2, that of sRGB codes would give 0.21
    std::fill_n(image.rgb.begin(), 3, std::uint8_t(255));
    ASSERT_TRUE(write_png(folder_ / "half.png", image, {}));
    const std::string png = *read_whole_file(folder_ / "half.png");
    GltfText text = triangle(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}})");
    text.textures = R"({"source":0})";
    text.nodes = R"({"mesh":0})";
    text.images =
        R"({"bufferView":)" + std::to_string(text.add_view(png.data(), png.size())) + R"(,"mimeType":"image/png"})";
    EXPECT_NEAR(scene(text).materials()[MaterialId(0)].reflectance[0], 0.5, 1e-12);
    text.images = R"({"uri":"half.png"})";
    EXPECT_NEAR(scene(text).materials()[MaterialId(0)].reflectance[0], 0.5, 1e-12) << "beside the file";
    text.images = R"({"uri":"absent.png"})";
    const CheckedScene absent = load(text);
    ASSERT_TRUE(absent.scene);
    EXPECT_EQ(warnings(absent, "absent.png"), 1u);
}

TEST_F(GltfFiles, ATriangleTakesItsPartOfAnAtlas) {
    Image atlas(8, 8);  // upper half white, lower half black
    std::fill_n(atlas.rgb.begin(), 3 * 32, std::uint8_t(255));
    ASSERT_TRUE(write_png(folder_ / "atlas.png", atlas, {}));
    GltfText text = triangle(
        R"({"name":"card","pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.6,0.6,0.6,1],)"
        R"("metallicFactor":0}})");
    const std::array<float, 6> corners = {0, 0, 1, 0, 0, 0.45F};
    const int places = text.add(corners.data(), sizeof corners, 5126, "VEC2", 3);
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":)" + std::to_string(places) +
                  R"(},"indices":1,"material":0}]})";
    text.textures = R"({"source":0})";
    text.images = R"({"uri":"atlas.png"})";
    text.nodes = R"({"mesh":0})";
    const Scene made = scene(text);
    EXPECT_NEAR(made.material(SurfaceId(0)).reflectance[0], 0.6, 1e-9);
    EXPECT_EQ(made.material(SurfaceId(0)).name, "card #cbcbcb");
    EXPECT_NEAR(made.materials()[MaterialId(0)].reflectance[0], 0.3, 1e-9);
}

TEST_F(GltfFiles, ColoursOfVerticesMultiplyTheReflectance) {
    for (const bool own_export : {false, true}) {
        GltfText text = triangle(
            R"({"name":"card","pbrMetallicRoughness":{"baseColorFactor":[0.6,0.6,0.6,1],"metallicFactor":0}})");
        const std::array<std::uint8_t, 12> corners = {255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255};
        const int colours = text.add(corners.data(), sizeof corners, 5121, "VEC4", 3);
        text.accessors.insert(text.accessors.size() - 1, R"(,"normalized":true)");
        const std::string light = own_export ? R"(,"_RADIOSITY":0)" : "";
        text.meshes = R"({"primitives":[{"attributes":{"POSITION":0,"COLOR_0":)" + std::to_string(colours) + light +
                      R"(},"indices":1,"material":0}]})";
        text.nodes = R"({"mesh":0})";
        const Spectrum reflectance = scene(text).material(SurfaceId(0)).reflectance;
        EXPECT_NEAR(mean(reflectance), own_export ? 0.6 : 0.6 * (2.0 / 3 + 1.0 / 3 + 0.2) / 3, 1e-6);
        if (bands == 3 && !own_export) {
            EXPECT_NEAR(reflectance[2], 0.6 * 0.2, 1e-6);
        }
    }
}

TEST_F(GltfFiles, LightsArePlacedByTheirNodes) {
    GltfText text = triangle();
    text.more =
        R"(,"extensions":{"KHR_lights_punctual":{"lights":[
            {"type":"point","color":[1,0.5,0.25],"intensity":40,"name":"bulb"},
            {"type":"spot","intensity":7,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},
            {"type":"directional","intensity":1000}]}})";
    text.nodes = R"({"mesh":0},{"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},
                    {"extensions":{"KHR_lights_punctual":{"light":1}}},
                    {"rotation":[-0.70710678118654757,0,0,0.70710678118654757],"extensions":{"KHR_lights_punctual":{"light":2}}})";
    const Scene s = scene(text);
    ASSERT_EQ(s.lights().size(), 3u);
    EXPECT_EQ(s.lights()[0].name, "bulb");
    EXPECT_EQ(s.lights()[0].position, (Point{1, -3, 2}));
    EXPECT_EQ(s.lights()[0].intensity[0], 40);
    EXPECT_EQ(s.lights()[1].kind, PunctualLight::Kind::spot);
    EXPECT_EQ(s.lights()[1].outer_cone, 0.5);
    EXPECT_EQ(s.lights()[1].direction, (Normal{0, 1, 0})) << "glTF's -z";
    EXPECT_NEAR(norm(s.lights()[2].direction - Normal{0, 0, -1}), 0, 1e-12) << "turned down";
}

TEST_F(GltfFiles, CamerasBecomeViews) {
    GltfText text = triangle();
    text.cameras = R"({"type":"perspective","name":"door","perspective":{"yfov":1,"aspectRatio":1.5,"znear":0.1}},
                      {"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"zfar":10,"znear":0.1}})";
    text.nodes = R"({"mesh":0},{"camera":0,"translation":[0,1,5]},{"camera":1})";
    const Scene s = scene(text);
    ASSERT_EQ(s.cameras().size(), 2u);
    EXPECT_EQ(s.cameras()[0].eye, (Point{0, -5, 1}));
    EXPECT_EQ(s.cameras()[0].target, (Point{0, -4, 1}));
    EXPECT_EQ(s.cameras()[0].up, (Vec3{0, 0, 1}));
    EXPECT_NEAR(s.cameras()[0].fov, 2 * std::atan(1.5 * std::tan(0.5)) * 180 / pi, 1e-9);
    EXPECT_EQ(s.cameras()[1].width, 4);
}

TEST_F(GltfFiles, PositionsMayBeQuantizedOrSparse) {
    GltfText text;
    const std::int16_t quantized[] = {0, 0, 0, 0, 0, 32767, 32767, 0, 0};
    text.add(quantized, sizeof quantized, 5122, "VEC3", 3);
    text.accessors.insert(text.accessors.size() - 1, R"(,"normalized":true)");
    const std::uint8_t place = 2;
    const float value[] = {1, 0, 0};
    const int places = text.add_view(&place, 1), values = text.add_view(value, sizeof value);
    const float zeros[] = {0, 0, 0, 0, 0, 1, 0, 0, 0};
    text.add(zeros, sizeof zeros, 5126, "VEC3", 3);
    text.accessors.insert(text.accessors.size() - 1,
                          R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(places) +
                              R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}");
    text.meshes = R"({"primitives":[{"attributes":{"POSITION":0}}]},{"primitives":[{"attributes":{"POSITION":1}}]})";
    text.nodes = R"({"mesh":0},{"mesh":1,"translation":[0,1,0]})";
    const Scene s = scene(text);
    ASSERT_EQ(s.surfaces().size(), 2u);
    for (const Surface& surface : s.surfaces()) EXPECT_NEAR(surface.area, 0.5, 1e-12);
}

TEST_F(GltfFiles, BuffersMayBeInsideOrOutsideTheFile) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0})";
    ASSERT_TRUE(write_file(folder_ / "a b.bin", text.data));
    ASSERT_TRUE(write_file(folder_ / "s.gltf", text.json("a%20b.bin")));
    EXPECT_TRUE(load_scene(folder_ / "s.gltf").scene);
    // Nine floats and three indices in base64, as in the buffer.
    ASSERT_TRUE(write_file(folder_ / "t.gltf", text.json("data:application/octet-stream;base64,"
                                                         "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAIA/AACAPwAAAAAAAAAAAAABAAIA")));
    const CheckedScene embedded = load_scene(folder_ / "t.gltf");
    ASSERT_TRUE(embedded.scene) << embedded.scene.error().message;
    EXPECT_NEAR(embedded.scene->surfaces()[SurfaceId(0)].area, 0.5, 1e-12);
    ASSERT_TRUE(write_file(folder_ / "u.gltf", text.json("absent.bin")));
    EXPECT_FALSE(load_scene(folder_ / "u.gltf").scene);
}

TEST_F(GltfFiles, ABinaryFileIsDetectedByItsFirstBytes) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0})";
    EXPECT_TRUE(load(text, "scene.bin").scene);
}

TEST_F(GltfFiles, MissingDataAreErrors) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0})";
    const auto replaced = [&](const std::string& what, const std::string& with) {
        GltfText out = text;
        for (std::string* part : {&out.accessors, &out.views, &out.meshes, &out.nodes})
            if (const auto at = part->find(what); at != part->npos) part->replace(at, what.size(), with);
        return first_error(out);
    };
    EXPECT_NE(replaced("\"count\":3", "\"count\":400000000").find("but there are only"), std::string::npos);
    EXPECT_NE(replaced("\"count\":3", "\"count\":6148914691236517206").find("but there are only"), std::string::npos);
    EXPECT_NE(replaced("\"byteLength\":36", "\"byteLength\":3600").find("the file does not have"), std::string::npos);
    EXPECT_NE(replaced("\"byteOffset\":36", "\"byteOffset\":18446744073709551612").find("the file does not have"),
              std::string::npos);
    EXPECT_NE(replaced("\"POSITION\":0", "\"POSITION\":17").find("accessor 17, but there are 2"), std::string::npos);
    EXPECT_NE(replaced("5123", "5126").find("whole numbers"), std::string::npos);
    EXPECT_NE(replaced("\"mesh\":0", "\"mesh\":0,\"children\":[0]").find("no root node"), std::string::npos);
    text.more = R"(,"scenes":[{"nodes":[0]}])";
    EXPECT_NE(replaced("\"mesh\":0", "\"mesh\":0,\"children\":[0]").find("two parents"), std::string::npos);
    EXPECT_NE(replaced("\"mesh\":0", "\"mesh\":0,\"children\":[5]").find("node 5 as child, but there are 1"),
              std::string::npos);
    text.data[36] = 7;
    EXPECT_NE(first_error(text).find("refers to vertex 7, but has 3 vertices"), std::string::npos) << first_error(text);
}

TEST_F(GltfFiles, UnknownRequiredExtensionsAreErrors) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0})";
    text.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    EXPECT_NE(first_error(text).find("KHR_draco_mesh_compression"), std::string::npos);
}

TEST_F(GltfFiles, CompressedBuffersAreNamedInTheError) {
    for (const std::string extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const std::string compressed = R"({"asset":{"version":"2.0"},"extensionsRequired":[")" + extension +
                                       R"("],"buffers":[{"byteLength":72,"extensions":{")" + extension +
                                       R"(":{"fallback":true}}}],"scenes":[{"nodes":[]}]})";
        ASSERT_TRUE(write_file(folder_ / "s.gltf", compressed));
        const CheckedScene out = load_scene(folder_ / "s.gltf");
        ASSERT_FALSE(out.scene);
        EXPECT_NE(out.scene.error().message.find("compressed (meshopt)"), std::string::npos)
            << out.scene.error().message;
    }
}

TEST_F(GltfFiles, DeeplyNestedJsonIsAnError) {
    GltfText text = triangle();
    text.nodes = R"({"mesh":0,"extras":)" + std::string(100000, '[') + std::string(100000, ']') + "}";
    EXPECT_NE(first_error(text).find("nested"), std::string::npos);
}

}  // namespace exitance

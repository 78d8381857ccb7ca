#include "exitance/io/scenes/textures/uv_file.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/measure/light_maps/uv_light_map.hpp"
#include "support/gltf_text.hpp"
#include "support/solved.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Vertices of a cube with sides of 1, and its six faces with charts of a quarter of the map's side, 0.05 apart.
struct CubeText {
    std::string points, faces;

    explicit CubeText(double unit = 1, bool y_is_up = false) {
        const double corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
        const int side[6][4] = {{1, 2, 3, 4}, {8, 7, 6, 5}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}};
        for (const auto& p : corner) {
            const double x = unit * p[0], y = unit * p[1], z = unit * p[2];
            points += "v " + std::to_string(x) + " " + std::to_string(y_is_up ? z : y) + " " +
                      std::to_string(y_is_up ? -y : z) + "\n";
        }
        for (int f = 0; f < 6; ++f) {
            const double u = 0.05 + 0.3 * (f % 3), v = 0.05 + 0.3 * (f / 3);
            for (const auto& [du, dv] : {std::pair(0.0, 0.0), {0.25, 0.0}, {0.25, 0.25}, {0.0, 0.25}})
                points += "vt " + std::to_string(u + du) + " " + std::to_string(v + dv) + "\n";
            faces += f == 1 ? "o lamp\nusemtl lamp\nf" : f == 0 ? "o floor\nusemtl wall\nf" : "o walls\nusemtl wall\nf";
            for (int k = 0; k < 4; ++k) faces += " " + std::to_string(side[f][k]) + "/" + std::to_string(4 * f + k + 1);
            faces += "\n";
        }
    }
};

class UvFile : public testing::Test {
  protected:
    std::string write(const std::string& name, const std::string& text) {
        EXPECT_TRUE(write_file(folder_ / name, text));
        return folder_ / name;
    }
    std::string write_cube(const CubeText& cube = CubeText()) {
        write("cube.mtl", "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0.3 0.3 0.3\nKe 2 2 2\n");
        return write("cube.obj", "mtllib cube.mtl\n" + cube.points + cube.faces);
    }
    static Scene load(const std::string& path, const LoadOptions& options = {}) {
        LoadedScene loaded = load_scene(std::vector{path}, options);
        EXI_CHECK(static_cast<bool>(loaded.scene));
        return std::move(*loaded.scene);
    }

    TemporaryFolder folder_;
};

/// Expects that the first two charts of the cube are where its text puts them.
void expect_cube(const Result<UvSet>& set, const Scene& scene) {
    ASSERT_TRUE(set) << set.error().message;
    ASSERT_EQ(set->triangles.size(), 12u);
    const Point origin = scene.box().lo;
    for (const UvTriangle& t : set->triangles) {
        EXPECT_GT(dot(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]), scene.surfaces()[t.surface].normal),
                  0);
        if (t.surface.value != 0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            // The floor is the first chart, upright: u follows x, and v, counted upwards, follows y.
            EXPECT_NEAR(t.place[k].x, 0.05 + 0.25 * (t.corner[k].x - origin.x), 1e-6);
            EXPECT_NEAR(t.place[k].y, 1 - 0.05 - 0.25 * (t.corner[k].y - origin.y), 1e-6);
        }
    }
}

TEST_F(UvFile, ObjCoordinatesFollowTheFaces) {
    const std::string path = write_cube();
    const Scene scene = load(path);
    const Result<UvSet> set = load_uv_set(scene, path, "own");
    expect_cube(set, scene);
    EXPECT_EQ(set->name, "vt");
    EXPECT_EQ(set->objects[set->triangles[0].object], "floor");
    EXPECT_TRUE(load_uv_set(scene, path, "TEXCOORD_0"));
    EXPECT_TRUE(load_uv_set(scene, path, "vt"));
    EXPECT_EQ(load_uv_set(scene, path, "TEXCOORD_1").error().code, ErrorCode::usage);
}

TEST_F(UvFile, TheUnitOfLengthAndTheUprightAxisAreThoseOfTheSolve) {
    const std::string path = write_cube(CubeText(1000, true));
    LoadOptions options;
    options.metres_per_unit = 0.001, options.y_is_up = true;
    const Scene scene = load(path, options);
    expect_cube(load_uv_set(scene, path, "own"), scene);
}

TEST_F(UvFile, ABentFaceKeepsTheCoordinatesOfItsCorners) {
    const std::string path = write("bent.obj",
                                   "v 0 0 0\nv 2 0 0\nv 2 2 0.7\nv 0 2 0\nv 0 0 3\nv 0 2 3\nv 2 0 3\n"
                                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\nf 5/1 6/4 7/2\n");
    const Scene scene = load(path);
    EXPECT_EQ(scene.surfaces().size(), 3u);  // the first face is cut into triangles
    const Result<UvSet> set = load_uv_set(scene, path, "own");
    ASSERT_TRUE(set) << set.error().message;
    double area = 0;
    for (const UvTriangle& t : set->triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(t.place[k].x, t.corner[k].x / 2, 1e-12);
            EXPECT_NEAR(t.place[k].y, 1 - t.corner[k].y / 2, 1e-12);
        }
        if (t.corner[0].z < 2) area -= 0.5 * cross(t.place[1] - t.place[0], t.place[2] - t.place[0]);
    }
    EXPECT_NEAR(area, 1, 1e-12);  // both triangles together cover the whole chart
}

TEST_F(UvFile, MissingCoordinatesAreErrorsThatNameTheObjects) {
    CubeText cube;
    const std::size_t at = cube.faces.find("o lamp");
    const std::size_t face = cube.faces.find("f 8/5", at);
    cube.faces.replace(face, cube.faces.find('\n', face) - face, "f 8 7 6 5");
    const std::string path = write_cube(cube);
    const Scene scene = load(path);
    const Result<UvSet> some = load_uv_set(scene, path, "own");
    ASSERT_FALSE(some);
    EXPECT_EQ(some.error().code, ErrorCode::bad_input);
    EXPECT_NE(some.error().message.find("1 of 6 faces"), std::string::npos) << some.error().message;
    EXPECT_NE(some.error().message.find("'lamp'"), std::string::npos) << some.error().message;

    const std::string bare = write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    EXPECT_EQ(load_uv_set(load(bare), bare, "own").error().code, ErrorCode::usage);
    EXPECT_EQ(load_uv_set(scene, "", "own").error().code, ErrorCode::cannot_read);
    EXPECT_EQ(load_uv_set(scene, "scene.stl", "own").error().code, ErrorCode::usage);
}

TEST_F(UvFile, AChangedFileIsAnError) {
    const std::string path = write_cube();
    const Scene scene = load(path);
    CubeText moved;
    moved.points.replace(0, moved.points.find('\n'), "v 0.3 0 0");
    write_cube(moved);
    const Result<UvSet> set = load_uv_set(scene, path, "own");
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::bad_input);
    EXPECT_NE(set.error().hint.find("solve it again"), std::string::npos);
}

/// A square in glTF's floor plane with two or three sets of coordinates, placed by two nodes of which one is mirrored.
test::GltfText square(bool double_sided) {
    test::GltfText text;
    const int points = text.positions({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
    const int indices = text.indices({0, 1, 2, 0, 2, 3});
    std::string sets;
    for (int set = 0; set < 3; ++set) {
        const float scale = 0.2f * static_cast<float>(set + 1);
        const std::vector<float> places{0, 0, 0, scale, scale, scale, scale, 0};
        sets +=
            ",\"TEXCOORD_" + std::to_string(set) + "\":" + std::to_string(text.add(places.data(), 32, 5126, "VEC2", 4));
    }
    text.meshes = R"({"name":"tile","primitives":[{"attributes":{"POSITION":)" + std::to_string(points) + sets +
                  R"(},"indices":)" + std::to_string(indices) + R"(,"material":0}]})";
    text.materials = std::string(R"({"name":"grey","doubleSided":)") + (double_sided ? "true}" : "false}");
    text.nodes = R"({"name":"first","mesh":0},{"name":"second","mesh":0,"translation":[3,0,0],"scale":[-1,1,1]})";
    return text;
}

TEST_F(UvFile, GltfSetsAreChosenByName) {
    const std::string path = write("square.glb", square(false).glb());
    const Scene scene = load(path);
    for (int set = 0; set < 3; ++set) {
        const Result<UvSet> uvs = load_uv_set(scene, path, "TEXCOORD_" + std::to_string(set));
        ASSERT_TRUE(uvs) << uvs.error().message;
        ASSERT_EQ(uvs->triangles.size(), 4u);
        EXPECT_EQ(uvs->objects, (std::vector<std::string>{"first", "second"}));
        for (const UvTriangle& t : uvs->triangles) {
            EXPECT_GT(
                dot(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]), scene.surfaces()[t.surface].normal),
                0);
            for (std::size_t k = 0; k < 3; ++k) {
                // Scene coordinates are (x, -z, y) of glTF's; u follows x, and v follows z.
                const double x = t.object == 0 ? t.corner[k].x : 3 - t.corner[k].x;
                EXPECT_NEAR(t.place[k].x, 0.2 * (set + 1) * x, 1e-6);
                EXPECT_NEAR(t.place[k].y, -0.2 * (set + 1) * t.corner[k].y, 1e-6);
            }
        }
        // Instances have the same coordinates, so each has a map of its own; only the second is mirrored.
        const UvLayout layout = lay_out(*uvs);
        EXPECT_EQ(layout.maps, 2u);
        EXPECT_EQ(layout.objects[0].mirrored, 0u);
        EXPECT_EQ(layout.objects[1].mirrored, 2u);
    }
    EXPECT_EQ(load_uv_set(scene, path, "own")->name, "TEXCOORD_1");
    const Result<UvSet> none = load_uv_set(scene, path, "TEXCOORD_3");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().hint, "it has TEXCOORD_0, TEXCOORD_1, TEXCOORD_2");
}

TEST_F(UvFile, BacksOfDoubleSidedFacesHaveNoCoordinates) {
    const std::string path = write("square.glb", square(true).glb());
    const Scene scene = load(path);
    ASSERT_EQ(scene.surfaces().size(), 8u);
    const Result<UvSet> uvs = load_uv_set(scene, path, "own");
    ASSERT_TRUE(uvs) << uvs.error().message;
    EXPECT_EQ(uvs->triangles.size(), 4u);
    EXPECT_EQ(uvs->back_faces, 4u);
}

/// A picture that is white up to a share of its width and dark beyond it.
Image two_tones(int size, double share) {
    Image image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) std::fill_n(image.at(x, y), 3, std::uint8_t(x < share * size ? 230 : 90));
    return image;
}

TEST_F(UvFile, PartsOfCutTrianglesKeepTheirCoordinates) {
    test::GltfText text = square(true);
    ASSERT_TRUE(write_png(folder_ / "tones.png", two_tones(20, 0.1), {}));
    text.materials =
        R"({"doubleSided":true,"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0}})";
    text.textures = R"({"source":0})", text.images = R"({"uri":"tones.png"})";
    const std::string path = write("square.glb", text.glb());
    const Scene scene = load(path);
    // The border is at x = 0.5: one of both triangles' corners is on it.
    ASSERT_GT(scene.surfaces().size(), 8u);
    const Result<UvSet> uvs = load_uv_set(scene, path, "TEXCOORD_2");
    ASSERT_TRUE(uvs) << uvs.error().message;
    double area = 0;
    for (const UvTriangle& t : uvs->triangles) {
        area += 0.5 * std::abs(cross(t.place[1] - t.place[0], t.place[2] - t.place[0]));
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = t.object == 0 ? t.corner[k].x : 3 - t.corner[k].x;
            EXPECT_NEAR(t.place[k].x, 0.6 * x, 1e-6);
            EXPECT_NEAR(t.place[k].y, -0.6 * t.corner[k].y, 1e-6);
        }
    }
    EXPECT_NEAR(area, 2 * 0.36, 1e-6);
    EXPECT_EQ(uvs->back_faces, scene.surfaces().size() / 2);
}

TEST_F(UvFile, ObjAndGltfAreCutAlike) {
    ASSERT_TRUE(write_png(folder_ / "tones.png", two_tones(20, 0.05), {}));
    test::GltfText text = square(false);
    text.materials =
        R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0}})";
    text.textures = R"({"source":0})", text.images = R"({"uri":"tones.png"})";
    text.nodes = R"({"mesh":0})";
    const Scene gltf = load(write("square.glb", text.glb()));
    write("m.mtl", "newmtl t\nKd 0.5 0.5 0.5\nmap_Kd tones.png\n");
    LoadOptions options;
    options.y_is_up = true;
    const Scene obj = load(write("square.obj",
                                 "mtllib m.mtl\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nvt 0 1\nvt 0 0.8\nvt 0.2 0.8\n"
                                 "vt 0.2 1\nusemtl t\nf 1/1 2/2 3/3 4/4\n"),
                           options);
    // The border is at x = 0.25: both are a bright and a dark rectangle, whether of triangles or of one face.
    ASSERT_EQ(obj.regions().size(), 2u);
    ASSERT_EQ(gltf.regions().size(), 2u);
    for (const RegionId r : obj.regions().ids()) {
        EXPECT_NEAR(obj.regions()[r].area, gltf.regions()[r].area, 1e-6);
        for (std::size_t b = 0; b < bands; ++b)
            EXPECT_NEAR(obj.material(r).reflectance[b], gltf.material(r).reflectance[b], 1e-6);
    }
    EXPECT_NEAR(std::min(obj.regions()[RegionId(0)].area, obj.regions()[RegionId(1)].area), 0.25, 1e-6);
}

TEST_F(UvFile, TrianglesWithAHoleInTheMiddleKeepTheirCoordinates) {
    // Pixels of the picture's left upper 8 x 8, which the square shows, are opaque at the border only.
    std::string rgba;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
            rgba += std::string(3, '\x80') + (x < 1 || y < 1 || x > 6 || y > 6 ? '\xff' : '\0');
    png_image image{};
    image.version = PNG_IMAGE_VERSION, image.width = image.height = 20, image.format = PNG_FORMAT_RGBA;
    ASSERT_TRUE(
        png_image_write_to_file(&image, std::string(folder_ / "frame.png").c_str(), 0, rgba.data(), 0, nullptr));
    test::GltfText text = square(false);
    text.materials =
        R"({"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1},"metallicFactor":0}})";
    text.textures = R"({"source":0})", text.images = R"({"uri":"frame.png"})";
    const std::string path = write("square.glb", text.glb());
    const Scene scene = load(path);
    double area = 0;
    for (const Surface& s : scene.surfaces()) area += s.area;
    EXPECT_NEAR(area, 2 * (1 - 36.0 / 64), 1e-6);
    const Result<UvSet> uvs = load_uv_set(scene, path, "TEXCOORD_0");
    ASSERT_TRUE(uvs) << uvs.error().message;
    double shown = 0;
    for (const UvTriangle& t : uvs->triangles)
        shown += 0.5 * std::abs(cross(t.place[1] - t.place[0], t.place[2] - t.place[0]));
    EXPECT_NEAR(shown, 0.04 * area, 1e-6);
}

TEST_F(UvFile, AnObjFileOfCutFacesOnlyKeepsItsCoordinates) {
    CubeText cube(1000, true);
    write("cube.mtl", "newmtl wall\nKd 0.8 0.8 0.8\nmap_Kd tones.png\nnewmtl lamp\nKd 0\nKe 2 2 2\nmap_Ke tones.png\n");
    // The border is in the middle of the charts of two columns.
    ASSERT_TRUE(write_png(folder_ / "tones.png", two_tones(40, 0.175), {}));
    for (int f = 0; f < 6; ++f) {
        const std::string column = "vt " + std::to_string(0.05 + 0.3 * (f % 3));
        for (std::size_t at = cube.points.find(column); at != std::string::npos; at = cube.points.find(column, at + 1))
            cube.points.replace(at, column.size(), "vt 0.050000");
    }
    for (const char* far : {"vt 0.600000", "vt 0.900000"})
        for (std::size_t at = cube.points.find(far); at != std::string::npos; at = cube.points.find(far, at + 1))
            cube.points.replace(at, 11, "vt 0.300000");
    const std::string path = write("cube.obj", "mtllib cube.mtl\n" + cube.points + cube.faces);
    LoadOptions options;
    options.metres_per_unit = 0.001, options.y_is_up = true;
    const Scene scene = load(path, options);
    ASSERT_EQ(scene.surfaces().size(), 12u);
    for (const Surface& s : scene.surfaces()) EXPECT_GT(s.whole, 0u);
    const Result<UvSet> set = load_uv_set(scene, path, "own");
    ASSERT_TRUE(set) << set.error().message;
    double area = 0;
    for (const UvTriangle& t : set->triangles)
        area += 0.5 * std::abs(cross(t.place[1] - t.place[0], t.place[2] - t.place[0]));
    EXPECT_NEAR(area, 6 * 0.0625, 1e-6);
}

TEST_F(UvFile, TheAtlasOfACubeHasTheLightOfProbes) {
    const std::string path = write_cube();
    const Scene scene = load(path);
    const Result<UvSet> set = load_uv_set(scene, path, "own");
    ASSERT_TRUE(set);
    SolveOptions options;
    options.error = 0.02;
    const Solution solution = solved(scene, options);
    const RadiosityFunction light(solution);
    Progress progress;
    const StopRequest stop;
    constexpr int size = 80;
    const Result<UvLightMaps> maps = bake_uv_light_maps(light, *set, {.size = {size, size}}, progress, stop);
    ASSERT_TRUE(maps);
    const UvLightMap& map = maps->maps[0];
    double square = 0, level = 0;
    int count = 0;
    for (const UvTriangle& t : set->triangles) {
        for (int k = 1; k < 20; ++k) {
            // The centre of a whole texel in the triangle, and its place in space.
            const Vec2 inside = t.place[0] + (0.05 * k * 0.6) * (t.place[1] - t.place[0]) +
                                (0.05 * (20 - k) * 0.6) * (t.place[2] - t.place[0]);
            const int x = static_cast<int>(size * inside.x), y = static_cast<int>(size * inside.y);
            const std::size_t i = map.light.index(x, y);
            if (map.light.share[i] < 1) continue;
            const Vec2 a = t.place[1] - t.place[0], b = t.place[2] - t.place[0];
            const Vec2 d = Vec2{(x + 0.5) / size, (y + 0.5) / size} - t.place[0];
            const double s = cross(d, b) / cross(a, b), r = cross(a, d) / cross(a, b);
            const ProbePoint point{t.corner[0] + s * (t.corner[1] - t.corner[0]) + r * (t.corner[2] - t.corner[0]),
                                   scene.surfaces()[t.surface].normal};
            const double expected = mean(light.at(std::span(&point, 1))[0].irradiance);
            square += std::pow(mean(map.light.at(i)) - expected, 2), level += expected, ++count;
        }
    }
    EXPECT_GT(count, 100);
    // The mean over a texel of 5 cm differs from the centre's light by its curvature, near edges by up to 1%, and
    // direct light of a probe may be estimated by rays at a third of the error.
    EXPECT_LT(std::sqrt(square / count) / (level / count), 0.01);
}

}  // namespace
}  // namespace exitance

#include "exitance/io/scenes/textures/normal_file.hpp"

#include <gtest/gtest.h>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/gltf_text.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

class NormalFile : public testing::Test {
  protected:
    std::string write(const std::string& name, const std::string& text) {
        EXPECT_TRUE(write_file(folder_ / name, text));
        return folder_ / name;
    }
    static Scene load(const std::string& path, const LoadOptions& options = {}) {
        LoadedScene loaded = load_scene(std::vector{path}, options);
        EXI_CHECK(static_cast<bool>(loaded.scene));
        return std::move(*loaded.scene);
    }

    TemporaryFolder folder_;
};

constexpr const char* lamp_text = "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKe 1 1 1\n";

/// A triangle in the plane z = 0 whose normals lean to x, and a lamp above it.
constexpr const char* leaning_text =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nv 0 1 2\nv 1 0 2\nvn 0 0 2\nvn 0.3 0 1\nusemtl grey\n"
    "f 1//1 2//2 3//-1\nusemtl lamp\nf 4 5 6\n";

TEST_F(NormalFile, ObjNormalsBelongToTheirCorners) {
    write("m.mtl", lamp_text);
    const std::string path = write("a.obj", leaning_text);
    const Scene scene = load(path);
    const std::vector<NormalTriangle> found = load_normals(scene, path);
    ASSERT_EQ(found.size(), 1u);
    const double length = std::hypot(0.3, 1.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const bool leans = norm(found[0].corner[k] - scene.outline(SurfaceId(0))[0]) > 0.5;
        EXPECT_NEAR(found[0].normal[k].x, leans ? 0.3 / length : 0, 1e-12);
        EXPECT_NEAR(found[0].normal[k].z, leans ? 1 / length : 1, 1e-12);
    }
    EXPECT_TRUE(load_normals(scene, folder_ / "missing.obj").empty());
    EXPECT_TRUE(load_normals(scene, "").empty());
}

TEST_F(NormalFile, ObjNormalsTurnWithTheUprightAxis) {
    write("m.mtl", lamp_text);
    const std::string path = write("a.obj", leaning_text);
    LoadOptions options;
    options.y_is_up = true, options.metres_per_unit = 0.01;
    const Scene scene = load(path, options);
    const std::vector<NormalTriangle> found = load_normals(scene, path);
    ASSERT_EQ(found.size(), 1u);
    for (const Normal& n : found[0].normal) {
        EXPECT_LT(n.y, -0.9);  // the z axis of the file
        EXPECT_GE(n.x, 0);
    }
}

TEST_F(NormalFile, UnreadableAndMissingNormalsAreLeftOut) {
    write("m.mtl", lamp_text);
    std::string text = leaning_text;
    text.replace(text.find("vn 0.3"), 6, "vn abc");
    const std::string path = write("a.obj", text);
    EXPECT_TRUE(load_normals(load(path), path).empty());
}

TEST_F(NormalFile, GltfNormalsStayPerpendicularUnderUnevenScales) {
    test::GltfText text;
    const int points = text.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 1}});
    const Vec3 n = normalized(Vec3{0, -1, 1});
    const int normals = text.positions({n, n, n});
    text.meshes = "{\"primitives\":[{\"attributes\":{\"POSITION\":" + std::to_string(points) +
                  ",\"NORMAL\":" + std::to_string(normals) + "},\"material\":0}]}";
    text.materials = "{\"emissiveFactor\":[1,1,1],\"doubleSided\":true}";
    text.nodes = "{\"mesh\":0,\"scale\":[1,3,-1],\"rotation\":[0.6,0,0,0.8]}";
    const std::string path = write("a.glb", text.glb());
    const Scene scene = load(path);
    const std::vector<NormalTriangle> found = load_normals(scene, path);
    ASSERT_EQ(found.size(), scene.surfaces().size());
    for (const NormalTriangle& t : found)
        for (const Normal& normal : t.normal)
            EXPECT_NEAR(norm(normal - scene.surfaces()[t.surface].normal), 0, 1e-6);  // single precision
}

}  // namespace
}  // namespace exitance

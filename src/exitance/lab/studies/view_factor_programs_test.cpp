#include "exitance/lab/studies/view_factor_programs.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/samples/generate.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// View3D's result for two surfaces with a given view factor.
std::string view3d_result(float factor) {
    const float numbers[] = {1, 2, 0, factor, factor / 2, 0, 0.9f, 0.9f};
    return std::string(32, ' ') + std::string(reinterpret_cast<const char*>(numbers), sizeof numbers);
}

CheckedScene written_and_read(const Scene& scene) {
    const TemporaryFolder folder;
    EXPECT_TRUE(write_file(folder / "s.vs3", view3d_text(scene, 1e-4)));
    return load_scene(folder / "s.vs3");
}

Scene generated(const std::string& family) {
    const Result<SceneDescription> description = generate_scene(family, {});
    EXPECT_TRUE(description);
    return *make_scene(*description).scene;
}

}  // namespace

TEST(View3dText, HoldsFacesOfAnyShapeInTheScenesOrder) {
    for (const char* family : {"door", "complex", "keyhole"}) {
        const Scene scene = generated(family);
        const CheckedScene read = written_and_read(scene);
        ASSERT_TRUE(read.scene) << family;
        std::vector<double> areas(scene.surfaces().size() + 1);  // the last one: obstructions
        for (const Surface& s : read.scene->surfaces()) areas.at(s.group.value) += s.area;
        for (const SurfaceId s : scene.surfaces().ids())
            EXPECT_NEAR(areas[s.value], scene.surfaces()[s].area, 1e-9 * scene.surfaces()[s].area)
                << family << ": corners have twelve digits, faces are centimetres wide";
    }
}

TEST(View3dResult, RequiresTheNumberOfSurfaces) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / "r.vf", view3d_result(0.5f)));
    const Result<AreaMatrix> matrix = read_view3d_result(folder / "r.vf", 2);
    ASSERT_TRUE(matrix) << matrix.error().message;
    EXPECT_EQ(matrix->areas, (std::vector<double>{1, 2}));
    EXPECT_EQ(matrix->factors, (std::vector<double>{0, 0.5, 0.25, 0}));
    EXPECT_FALSE(read_view3d_result(folder / "r.vf", 3));
    EXPECT_FALSE(read_view3d_result(folder / "none.vf", 2));
}

}  // namespace exitance

// Solves one scene in every format and compares the light. Blender wrote the GLB file (see
// tests/data/blender_export.py).
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "exitance/error/area_samples.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/obj/obj_writer.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/samples/generate.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Formats the scene as a Radiance file. Radiance's reflectors have two sides, and its emitters are black.
std::string radiance_text(const SceneDescription& d) {
    std::string out;
    for (const Material& m : d.materials) {
        const Spectrum value = m.emits() ? radiance_of_exitance(m.exitance) : m.reflectance;
        out += fmt::format("void {} {} 0 0 {} {} {} {}{}\n", m.emits() ? "light" : "plastic", m.name, m.emits() ? 3 : 5,
                           value[0], value[bands / 2], value[bands - 1], m.emits() ? "" : " 0 0");
    }
    for (std::size_t i = 0; i < d.faces.size(); ++i) {
        const auto& face = d.faces[i];
        out += fmt::format("{} polygon {}.{} 0 0 {}", d.materials[face.material].name, d.groups[face.group], i,
                           3 * face.corners.size());
        for (std::uint32_t c : face.corners)
            out += fmt::format(" {} {} {}", d.points[c].x, d.points[c].y, d.points[c].z);
        out += '\n';
    }
    return out;
}

Scene loaded(const std::string& path) {
    CheckedScene checked = load_scene(path);
    EXPECT_TRUE(checked.scene) << path << ": " << checked.scene.error().message;
    if (!checked.scene) std::abort();
    return std::move(*checked.scene);
}

Solution solved(const Scene& scene, double error) {
    Progress progress;
    const StopRequest stop;
    Result<Solution> solution = solve_scene(scene, {.error = error}, progress, stop);
    EXI_CHECK(static_cast<bool>(solution));
    return std::move(*solution);
}

double difference(const std::vector<Light>& a, const std::vector<Light>& b) {
    double square = 0, sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        square += mean((a[i].irradiance - b[i].irradiance) * (a[i].irradiance - b[i].irradiance));
        sum += mean(a[i].irradiance);
    }
    const double n = static_cast<double>(a.size());
    return std::sqrt(square / n) / (sum / n);
}

}  // namespace

TEST(RoundTrip, ASceneHasTheSameLightInEveryFormat) {
    if constexpr (bands != 3) return;
    for (const auto& [family, parameters] : std::vector<std::pair<std::string, std::map<std::string, std::string>>>{
             {"cornell", {}}, {"complex", {{"m", "6"}}}}) {
        Result<SceneDescription> description = generate_scene(family, parameters);
        ASSERT_TRUE(description);
        for (Material& m : description->materials)
            if (m.emits()) m.reflectance = {};
        const TemporaryFolder folder;
        ASSERT_TRUE(write_obj(*description, folder / "s.obj"));
        ASSERT_TRUE(write_file(folder / "s.rad", radiance_text(*description)));
        const Scene obj = loaded(folder / "s.obj"), rad = loaded(folder / "s.rad"),
                    glb = loaded(test::source_folder() + "/tests/data/" + family + "_blender.glb");
        EXPECT_EQ(glb.regions().size(), obj.regions().size()) << "triangles are polygons again";
        EXPECT_NEAR(glb.box().diagonal(), obj.box().diagonal(), 1e-6 * obj.box().diagonal());

        const std::vector<ProbePoint> points = points_uniform_in_area(obj, 300, 1);
        const Solution reference = solved(obj, 0.035);
        const RadiosityFunction light(reference);
        const auto direct = light.at(points, Component::direct), total = light.at(points);
        for (const Scene* other : {&glb, &rad}) {
            const Solution solution = solved(*other, 0.035);
            const RadiosityFunction function(solution);
            // Coordinates in single precision shift shadow edges by 1e-7 of the scene: far below the requested 0.2%.
            EXPECT_LT(difference(direct, function.at(points, Component::direct)), 1e-4) << other->file();
            // Each solution is within 3.5% of the exact one, with independent noise: together sqrt(2) times as much.
            EXPECT_LT(difference(total, function.at(points)), 0.05) << other->file();
        }
    }
}

}  // namespace exitance

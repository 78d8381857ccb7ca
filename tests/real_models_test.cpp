#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/transport/stage.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Folder with scenes; "real" has models with typical properties of users' files, one per model.
fs::path scenes() {
    return fs::path(test::data_folder()) / "scenes";
}

CheckedScene load_real(const char* name) {
    return load_scene((scenes() / "real" / name).string());
}

Result<Solution> solve_direct(const Scene& scene) {
    Progress progress;
    const StopRequest stop;
    return solve_scene(scene, {.bounces = 0, .error = 0.1}, progress, stop);
}

double irradiance_at(const Solution& solution, const Point& x) {
    const std::vector<ProbePoint> points{{x, {0, 0, 1}}};
    return RadiosityFunction(solution).at(points)[0].irradiance[0];
}

std::size_t count(const CheckedScene& checked, Finding::Kind kind) {
    return static_cast<std::size_t>(
        std::ranges::count_if(checked.findings, [&](const Finding& f) { return f.kind == kind; }));
}

TEST(RealModels, WhateverIsSolvedCanBeReadBack) {
    const TemporaryFolder temporary;
    std::size_t solved = 0;
    for (const char* folder : {"degenerate", "real"})
        for (const auto& entry : fs::directory_iterator(scenes() / folder)) {
            if (entry.path().extension() != ".obj") continue;
            const CheckedScene checked = load_scene(entry.path().string());
            if (!checked.scene || checked.scene->surfaces().size() > 100) continue;
            const Result<Solution> solution = solve_direct(*checked.scene);
            ASSERT_TRUE(solution) << entry.path();
            ASSERT_TRUE(write_solution(temporary / "s.h5", *solution)) << entry.path();
            const Result<Solution> again = load_solution(temporary / "s.h5");
            EXPECT_TRUE(again) << entry.path() << ": " << again.error().message;
            ++solved;
        }
    EXPECT_GT(solved, 15u);
}

TEST(RealModels, ANeedleShapedFaceDoesNotPreventASolution) {
    const CheckedScene checked = load_real("slivers.obj");
    ASSERT_TRUE(checked.scene);
    EXPECT_EQ(count(checked, Finding::Kind::repair), 1u);
}

TEST(RealModels, AWindowOutlineInsideItsWallIsAHole) {
    const CheckedScene checked = load_real("hole_same_turn.obj");
    ASSERT_TRUE(checked.scene);
    EXPECT_NEAR(checked.scene->surfaces()[SurfaceId(0)].area, 10, 1e-9);
    EXPECT_EQ(count(checked, Finding::Kind::repair), 1u);
}

TEST(RealModels, OfCoplanarFacesTheLastOneIsLit) {
    const CheckedScene checked = load_real("coplanar.obj");
    ASSERT_TRUE(checked.scene);
    const Result<Solution> solution = solve_direct(*checked.scene);
    ASSERT_TRUE(solution);
    const RadiosityFunction light(*solution);
    // Floor, rug, and the third face, which covers both. Radiosity over irradiance is the reflectance of the visible
    // face.
    const std::vector<ProbePoint> points{{{0.5, 0.5, 0.3}, {0, 0, 1}},
                                         {{1.3, 2, 0.3}, {0, 0, 1}},
                                         {{2, 1.5, 0.3}, {0, 0, 1}},
                                         {{2, 1.1, 0.3}, {0, 0, 1}}};
    const std::vector<Light> values = light.at(points);
    const double reflectances[] = {0.5, 0.1, 0.8, 0.8};
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_GT(values[i].irradiance[0], 0.9) << i;
        EXPECT_NEAR(values[i].radiosity[0] / values[i].irradiance[0], reflectances[i], 1e-6) << i;
    }
    // Rays from the lamp hit the same faces.
    const Normal down{0, 0, -1};
    for (std::size_t i = 0; i < points.size(); ++i) {
        RayHit hit;
        const Point from = points[i].x + Vec3{0.01, 0.02, 1.5};
        light.stage().tracer.nearest(std::span(&down, 1), from, RegionId(), std::span(&hit, 1));
        EXPECT_NEAR(checked.scene->material(hit.surface).reflectance[0], reflectances[i], 1e-6) << i;
    }
}

TEST(RealModels, WhiteAndBentFacesAreRepairedAndReportedOnce) {
    const CheckedScene checked = load_real("white.obj");
    ASSERT_TRUE(checked.scene);
    EXPECT_EQ(count(checked, Finding::Kind::repair), 2u);
    const Result<Solution> solution = solve_direct(*checked.scene);
    ASSERT_TRUE(solution);
    EXPECT_GT(irradiance_at(*solution, checked.scene->outline(SurfaceId(0))[0]), 0);
}

TEST(RealModels, ALuminaireShinesAsItsDataSay) {
    const TemporaryFolder temporary;
    const CheckedScene checked = load_real("luminaire.rad");
    ASSERT_TRUE(checked.scene) << checked.scene.error().message;
    const Result<Solution> solution = solve_direct(*checked.scene);
    ASSERT_TRUE(solution);
    // 1000 W/(m^2 sr) from 0.04 m^2 at 2.5 m give 6.4 W/m^2; the size of the lamp reduces that by 0.7%.
    EXPECT_NEAR(irradiance_at(*solution, {0, 0, 0}), 6.355, 0.006);
    EXPECT_NEAR(irradiance_at(*solution, {1.5, 0, 0}), 3.16, 0.005);
    EXPECT_LT(solution->statistics.energy.defect, 0.02) << "what misses the floor is told as such";
    ASSERT_TRUE(write_solution(temporary / "s.h5", *solution));
    const Result<Solution> again = load_solution(temporary / "s.h5");
    ASSERT_TRUE(again) << again.error().message;
    for (const double x : {0.0, 1.5}) EXPECT_EQ(irradiance_at(*again, {x, 0, 0}), irradiance_at(*solution, {x, 0, 0}));
}

TEST(RealModels, NestedPatternsAreOmittedAndReported) {
    const CheckedScene checked = load_real("chained_patterns.rad");
    ASSERT_TRUE(checked.scene) << checked.scene.error().message;
    EXPECT_EQ(count(checked, Finding::Kind::warning), 2u) << "patterns, and that there is no light";
}

TEST(RealModels, TwoFilesMakeAScene) {
    const std::vector<std::string> files = {(scenes() / "real" / "materials.rad").string(),
                                            (scenes() / "real" / "room_part.rad").string()};
    const CheckedScene checked = load_scene(files, {});
    ASSERT_TRUE(checked.scene) << checked.scene.error().message;
    EXPECT_EQ(checked.scene->surfaces().size(), 3u);
    EXPECT_EQ(checked.scene->emitters().size(), 1u);
}

}  // namespace
}  // namespace exitance

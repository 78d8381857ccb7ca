// Compares light near edges with solutions of the continuous equation.
#include <gtest/gtest.h>

#include <filesystem>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/places.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

TEST(OpenScenes, HaveAtMostTwoPercentErrorAtEveryProbe) {
    if constexpr (bands != 3) GTEST_SKIP() << "the references have three bands";
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "reference" / "analytic";
    for (const char* name : {"plates_1", "plates_0.5"}) {
        const std::string scene_file = (folder / name / (std::string(name) + ".obj")).string();
        const CheckedScene checked = load_scene(scene_file);
        ASSERT_TRUE(checked.scene);
        const Solution solution = solved(*checked.scene, {.error = 0.005});
        const RadiosityFunction function(solution);
        for (const char* probes : {"reference_lines.csv", "reference_uniform.csv"}) {
            const Result<ProbeReference> reference = load_probe_reference((folder / name / probes).string());
            ASSERT_TRUE(reference);
            std::vector<ProbePoint> points;
            for (std::size_t i = 0; i < reference->probes.size(); ++i)
                points.push_back({reference->probes.points[i], reference->probes.normals[i]});
            const std::vector<Light> light = function.at(points);
            for (std::size_t i = 0; i < points.size(); ++i)
                for (std::size_t k = 0; k < bands; ++k) {
                    const double E = reference->irradiance[i][k];
                    // The requested 0.5% is the RMS error of the scene; in dark places, too, the error must be at most
                    // 2%.
                    EXPECT_NEAR(light[i].irradiance[k], E, 0.02 * E) << name << " point " << i;
                }
        }
    }
}

}  // namespace
}  // namespace exitance

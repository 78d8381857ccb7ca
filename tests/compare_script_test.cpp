#include <gtest/gtest.h>

#include <fstream>

#include "exitance/base/random.hpp"
#include "exitance/io/files/probe_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/reference/compare.hpp"
#include "exitance/scene/locator.hpp"
#include "support/places.hpp"
#include "support/run.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Compares the program's error measure with that of an independent script, for references with a known random
/// perturbation.
class CompareScript : public testing::TestWithParam<const char*> {};

TEST_P(CompareScript, MeasuresTheSameErrors) {
    if constexpr (bands != 3) GTEST_SKIP() << "the references have three bands";
    const fs::path data = test::data_folder();
    const std::string name = GetParam(), scene_file = (data / "scenes" / (name + ".obj")).string();
    const std::string reference_file = (data / "reference" / (name + ".csv")).string();
    const std::string script = (data / "reference" / "compare.py").string();

    const CheckedScene checked = load_scene(scene_file);
    ASSERT_TRUE(checked.scene);
    const Scene& scene = *checked.scene;
    const Result<ProbeReference> reference = load_probe_reference(reference_file);
    ASSERT_TRUE(reference) << reference.error().message;

    const TemporaryFolder folder;
    Result<ProbeWriter> writer = ProbeWriter::create(folder / "result.csv", {.radiosity = false});
    ASSERT_TRUE(writer);
    std::vector<Spectrum> result;
    std::vector<SurfaceId> surfaces;
    const Locator locator(scene);
    RandomStream random(1, Stream::mesh);
    for (std::size_t i = 0; i < reference->irradiance.size(); ++i) {
        Spectrum e = reference->irradiance[i];
        for (std::size_t b = 0; b < bands; ++b) e[b] *= 1.01 + 0.1 * (random.uniform() - 0.5);
        const Point& x = reference->probes.points[i];
        writer->add(x, reference->probes.normals[i], e);
        result.push_back(e);
        surfaces.push_back(locator.find(x, reference->probes.normals[i]));
        EXPECT_FALSE(surfaces.back().is_none());
    }
    ASSERT_TRUE(writer->commit());
    const ErrorMeasure m = measure_error({result, reference->irradiance, reference->standard_errors, surfaces}, scene);

    const Ran ran =
        run("python3 '" + script + "' '" + reference_file + "' '" + (folder / "result.csv") + "' '" + scene_file + "'");
    ASSERT_EQ(ran.status, 0) << ran.output;
    const auto figure = [&](const std::string& before, std::size_t from = 0) {
        const std::size_t at = ran.output.find(before, from);
        return at == std::string::npos ? NAN : std::stod(ran.output.substr(at + before.size())) / 100;
    };
    const double digits = 1e-6;  // the script prints four decimals of a percentage
    const std::size_t e = ran.output.find("irradiance:");
    if (m.of_irradiance) {
        EXPECT_NEAR(m.relative_rms_error, figure("relative RMS ", e), digits) << ran.output;
        EXPECT_NEAR(m.reference_noise, figure("(noise ", e), digits);
        EXPECT_NEAR(m.bias, figure("mean difference ", e), digits);
    } else {
        EXPECT_NEAR(m.relative_rms_error, figure("relative RMS error "), digits) << ran.output;
        EXPECT_NEAR(m.raw_relative_rms_error, figure("(raw "), digits);
        EXPECT_NEAR(m.reference_noise, figure("reference noise "), digits);
    }
    EXPECT_NEAR(m.median_relative_error, figure("median "), digits);
    EXPECT_NEAR(m.p95_relative_error, figure("p95 "), digits);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CompareScript, testing::Values("complex_m1", "cornell", "chair", "blocker_h0p7"));

}  // namespace
}  // namespace exitance

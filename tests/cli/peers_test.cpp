#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/lab/peers/peers.hpp"
#include "exitance/lab/studies/task_schedules.hpp"
#include "run_program.hpp"
#include "support/own_programs.hpp"

namespace exitance::test {
namespace {

namespace fs = std::filesystem;

/// Runs studies with the test's own programs in place of peers.
class Peers : public OwnPrograms {
  protected:
    std::string results(const std::string& options) {
        const std::string study =
            "title = \"p\"\n[[scene]]\nname = \"tube\"\ngenerate = \"tube length=2\"\n"
            "[reference]\npoints = 20\npaths = 64\n"
            "[[row]]\nlabel = \"other\"\npeer = \"radiance\"\noptions = \"" +
            options + "\"\n";
        EXPECT_TRUE(write_file(folder_ / "p.toml", study));
        const Finished run = run_program({"experiment", folder_ / "p.toml", "-o", folder_ / "p"});
        EXPECT_EQ(run.status, 0) << run.err;
        return read_text(folder_ / "p/results.csv");
    }
};

}  // namespace

TEST_F(Peers, AreMeasuredAtThePointsOfTheReference) {
    // A peer that reports 0 everywhere has an error of 100% of the mean, or more.
    make("rtrace", "while read line; do echo 0 0 0; done; echo \"$@\" > " + std::string(folder_ / "words") + "\n");
    const std::string table = results("-ab {value}");
    EXPECT_NE(table.find(",radiance,"), std::string::npos) << table;
    EXPECT_NE(table.find(",done,"), std::string::npos) << table;
    EXPECT_NE(read_text(folder_ / "words").find("-I+ -n 1 -ab 0 !oconv scene.rad"), std::string::npos);
}

TEST_F(Peers, FailuresAndMissingOutputAreReportedInTheirRows) {
    make("rtrace", "echo 1 1 1\n");
    EXPECT_NE(results("-ab 1").find("failed: it printed light at 1 points instead of 20"), std::string::npos);
    make("rtrace", "echo 'fatal: no octree' >&2; exit 1\n");
    EXPECT_NE(results("-ab 2").find("failed: fatal: no octree"), std::string::npos);
}

TEST_F(Peers, RejectUnsupportedOptions) {
    const PeerScene scene;
    const auto words = blender_peer.prepare({scene, {"samples=3", "depth=2"}, 1, folder_ / "."});
    ASSERT_FALSE(words);
    EXPECT_EQ(words.error().hint, "name=value, with bounces, samples");
}

TEST_F(Peers, PixelsOfPovRayAreRadiosity) {
    PeerScene scene;
    scene.max_light = 2;
    const Spectrum rho(0.5), emitted(0.25);
    scene.places = {{{}, rho, emitted}, {{}, {}, {}}};
    // Two uniform pixels, 1 and 1/4 of the maximum (exponents 128 + 1 and 128 - 1, mantissas of 128).
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const std::string pixels{'\x80', '\x80', '\x80', '\x81', '\x80', '\x80', '\x80', '\x7f'};
    ASSERT_TRUE(write_file(folder_ / "light.hdr", header + pixels));
    const auto light = povray_peer.read({scene, {}, 1, folder_ / "."}, {});
    ASSERT_TRUE(light) << light.error().message;
    ASSERT_EQ(light->irradiance.size(), 2u);
    EXPECT_NEAR(light->irradiance[0][0], (2 * 1 - 0.25) / 0.5, 0.03) << "mantissas have 8 bits";
    EXPECT_EQ(light->irradiance[1][0], 0) << "nothing is reflected";
    ASSERT_TRUE(write_file(folder_ / "light.hdr", header + "abc"));
    EXPECT_FALSE(povray_peer.read({scene, {}, 1, folder_ / "."}, {}));
}

TEST(GraphOfLoops, HasOneLoopPerIterationAndBarriersBetween) {
    TaskTrace trace;
    trace.begin_phase("p");
    TaskTrace::Loop loop = trace.begin_loop("l", 2, 1, 2);
    loop.begin = 1, loop.end = 4;
    for (std::uint64_t i = 0; i < 2; ++i) {
        TaskTrace::Task& task = loop.tasks.emplace_back();
        task.index = i, task.begin = 1 + static_cast<double>(i), task.end = 3 + static_cast<double>(i);
    }
    trace.end_loop(std::move(loop));
    const TaskGraph graph = graph_of_loops(trace);
    ASSERT_EQ(graph.iterations.size(), 1u);
    ASSERT_EQ(graph.tasks.size(), 2u);
    EXPECT_EQ(graph.tasks[1].polygon, 1u);
    EXPECT_NEAR(graph.tasks[0].cost(), 2, 1e-6);
    EXPECT_NEAR(graph.iterations[0].serial, 1, 1e-6) << "before the first loop";
}

}  // namespace exitance::test

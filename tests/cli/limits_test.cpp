#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "cli/small_scene.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "support/sample_solution.hpp"

namespace exitance::test {
namespace {

const std::vector<std::string> verbs = {"solve",     "probe",      "compare", "stats",       "mix",   "export",
                                        "render",    "bake",       "report",  "daylight",    "check", "generate",
                                        "luminaire", "experiment", "view",    "viewfactors", "sweep"};

std::size_t lines_in(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Points in free space, each of which needs 4,096 rays: about 20 s of work.
std::string many_points(std::size_t count = 100000) {
    std::string text = "x,y,z,nx,ny,nz\n";
    for (std::size_t i = 0; i < count; ++i) text += "0.5,0.5,0." + std::to_string(100 + i % 800) + ",0,0,1\n";
    return text;
}

}  // namespace

TEST(ProgramLimits, EveryVerbSupportsThem) {
    for (const std::string& verb : verbs) {
        const std::string help = run_program({verb, "--help"}).out;
        EXPECT_NE(help.find("--time-limit SECONDS"), std::string::npos) << verb;
        EXPECT_NE(help.find("--memory-limit SIZE"), std::string::npos) << verb;
    }
}

TEST(ProgramLimits, AMemoryLimitBelowTheProgramsOwnSizeEndsEveryVerbWithoutOutput) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    const std::string solution = folder / "s.h5", scene = write_small_room(folder);
    write_text(folder / "p.csv", "x,y,z,nx,ny,nz\n0.5,0.5,0,0,0,1\n");
    const std::vector<std::vector<std::string>> runs{
        {"solve", scene, "-o", folder / "out.h5"},
        {"probe", solution, "--points", folder / "p.csv", "-o", folder / "out.csv"},
        {"compare", solution, solution},
        {"stats", solution},
        {"export", solution, "-o", folder / "out.glb"},
        {"render", solution, "-o", folder / "out.png"},
        {"bake", solution, "-o", folder / "out"},
        {"report", solution, "-o", folder / "out.html"},
        {"check", scene},
        {"generate", "complex", "-o", folder / "out.obj"},
    };
    for (std::vector<std::string> words : runs) {
        words.insert(words.end(), {"--memory-limit", "1M"});
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 5) << words[0] << ": " << run.err;
        EXPECT_NE(run.err.find("error: --memory-limit: "), std::string::npos) << words[0] << ": " << run.err;
        EXPECT_EQ(run.out, "") << words[0];
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
        EXPECT_FALSE(entry.path().filename().string().starts_with("out")) << entry.path();
}

TEST(ProgramLimits, ATimeLimitLeavesACompletePictureOfFewerSamples) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    // Requests more samples than any machine computes in this time.
    const Finished run = run_program({"render", folder / "s.h5", "-o", folder / "p.exr", "--size", "1000x800",
                                      "--samples", "1024", "--camera", "0.5,0.5,0.5 2,0.5,0.4", "--time-limit", "3"});
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_NE(run.err.find("stopped by the time limit: "), std::string::npos) << run.err;
    EXPECT_FALSE(read_text(folder / "p.exr").empty());
}

TEST(ProgramLimits, ASignalLeavesThePictureSoFar) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    // The first pass takes some 30 ms, all samples half a minute.
    RunningProgram program({"render", folder / "s.h5", "-o", folder / "p.png", "--size", "200x160", "--samples", "1024",
                            "--camera", "0.5,0.5,0.5 2,0.5,0.4", "--progress", "json"});
    ASSERT_TRUE(program.wait_for("\"fraction\":0.0"));
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    program.send(SIGINT);
    const Finished run = program.finish();
    EXPECT_EQ(run.status, 130) << run.err;
    EXPECT_TRUE(read_text(folder / "p.png").starts_with("\x89PNG"));
}

TEST(ProgramLimits, ATimeLimitLeavesTheFirstRowsOfAProbe) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    write_text(folder / "p.csv", many_points());
    const Finished run = run_program(
        {"probe", folder / "s.h5", "--points", folder / "p.csv", "-o", folder / "some.csv", "--time-limit", "0.8"});
    EXPECT_EQ(run.status, 4) << run.err;
    const std::string some = read_text(folder / "some.csv");
    const std::size_t rows = lines_in(some) - 1;
    EXPECT_GT(rows, 0u);
    EXPECT_LT(rows, 100000u);
    EXPECT_NE(run.err.find("the first " + std::to_string(rows) + " points are finished"), std::string::npos) << run.err;
    // The rows are equal to those of a run without a limit.
    const std::size_t few = std::min<std::size_t>(rows, 100);
    const Finished whole = run_program({"probe", folder / "s.h5", "--points", "-"}, many_points(few));
    EXPECT_TRUE(some.starts_with(whole.out));
}

TEST(ProgramLimits, ATimeLimitEndsABakeWithoutMaps) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    const Finished run =
        run_program({"bake", folder / "s.h5", "-o", folder / "maps", "--density", "2000", "--time-limit", "0.5"});
    EXPECT_EQ(run.status, 5) << run.err;
    EXPECT_NE(run.err.find("error: --time-limit: "), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "maps/lightmaps.json"));
}

}  // namespace exitance::test

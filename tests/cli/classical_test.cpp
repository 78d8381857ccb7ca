#include <gtest/gtest.h>

#include "small_scene.hpp"

namespace exitance::test {

TEST(ProgramClassical, WritesSnapshotsAndReportsItsVariant) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), output = folder / "s.h5";
    const Finished run = run_program({"solve", scene, "-o", output, "--json", "--method", "matrix", "--direct",
                                      "carried", "--mesh", "uniform", "--mesh-size", "1", "--gather", "off",
                                      "--relaxation", "jacobi", "--snapshots", "rounds"});
    EXPECT_EQ(run.status, 0) << run.err;
    const Finished stats = run_program({"stats", output, "--json"});
    for (const std::string& text : {run.out, stats.out}) {
        EXPECT_NE(text.find("\"direct\": \"carried\""), std::string::npos) << text;
        EXPECT_NE(text.find("\"mesh_kind\": \"uniform\""), std::string::npos);
        EXPECT_NE(text.find("\"relative_error_estimate\": null"), std::string::npos);
    }
    EXPECT_EQ(run_program({"stats", folder / "s.0001.h5"}).status, 0);
    EXPECT_EQ(run_program({"probe", folder / "s.0002.h5", "--points", "-"}, "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n").status, 0);
}

TEST(ProgramClassical, StatsTellsHowLinksWereFound) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const auto found_by = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"solve", scene, "-o", folder / "s.h5", "-q", "--recipe", "classical-wavelet"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(run_program(words).status, 0);
        const std::string stats = run_program({"stats", folder / "s.h5", "--json"}).out;
        EXPECT_NE(stats.find("\"mesh_kind\": \"uniform\""), std::string::npos) << stats;
        const std::string key = "\"links_found_by\": \"";
        const std::size_t at = stats.find(key) + key.size();
        return stats.substr(at, stats.find('"', at) - at);
    };
    EXPECT_EQ(found_by({"--mesh-size", "2"}), "leaves");
    EXPECT_EQ(found_by({"--oracle", "bf", "--threshold", "10"}), "bf");
    EXPECT_EQ(found_by({"--oracle", "kernel", "--threshold", "10"}), "kernel");
}

TEST(ProgramClassical, AnInterruptedSolveKeepsACheckpointThatIsContinued) {
    const TemporaryFolder folder;
    std::vector<std::string> solve{"solve",
                                   write_small_room(folder),
                                   "-o",
                                   folder / "s.h5",
                                   "--recipe",
                                   "classical-progressive",
                                   "--mesh-size",
                                   "0.2",
                                   "--output-light",
                                   "elements"};
    std::vector<std::string> limited = solve;
    limited.insert(limited.end(), {"--checkpoint-every", "0.01", "--time-limit", "0.4"});
    ASSERT_EQ(run_program(limited).status, 4);
    solve.push_back("--resume");
    const Finished run = run_program(solve);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("continuing from"), std::string::npos) << run.err;
}

TEST(ProgramClassical, UnsupportedOptionsAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), output = folder / "s.h5";
    const std::vector<std::vector<std::string>> wrong = {{"--method", "matrix", "--kernel", "point"},
                                                         {"--method", "wavelet", "--ambient"},
                                                         {"--method", "progressive", "--refine-gradient", "1"},
                                                         {"--method", "matrix", "--form-factors", "vertex"},
                                                         {"--method", "progressive", "--relaxation", "sor"},
                                                         {"--certify", "on", "--direct", "carried"},
                                                         {"--threshold", "1"},
                                                         {"--snapshots", "sometimes"},
                                                         {"--sor-factor", "2.5"},
                                                         {"--direct", "carried", "--bounces", "1"}};
    for (std::vector<std::string> words : wrong) {
        words.insert(words.begin(), {"solve", scene, "-o", output});
        EXPECT_EQ(run_program(words).status, 2) << words[4] << " " << words.back();
    }
}

TEST(ProgramClassical, GrowingCellsAreUnchangedWithoutAGather) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const auto light = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"solve",         scene,         "-o", folder / "s.h5", "-q", "--method",
                                       "growing-cells", "--max-units", "16"};
        words.insert(words.end(), more.begin(), more.end());
        const int status = run_program(words).status;
        EXPECT_TRUE(status == 0 || status == 4);
        return run_program({"probe", folder / "s.h5", "--points", "-"}, "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,2,0,0,0,1\n")
            .out;
    };
    const std::string raw = light({"--gather", "off"});
    EXPECT_EQ(raw, light({"--smoothing", "off"}));
    EXPECT_NE(raw, light({"--gather", "on"}));
}

}  // namespace exitance::test

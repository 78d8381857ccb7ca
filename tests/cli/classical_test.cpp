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
                                                         {"--direct", "carried", "--resume"}};
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

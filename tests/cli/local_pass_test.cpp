#include <gtest/gtest.h>

#include "small_scene.hpp"

namespace exitance::test {

TEST(ProgramLocalPass, SolvesByEachRuleAndStatsReportsIt) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), output = folder / "s.h5";
    for (const std::string rule : {"a", "d", "e"}) {
        const Finished run = run_program(
            {"solve", scene, "-o", output, "--method", "discontinuity", "--local-pass", rule, "--error", "0.3"});
        EXPECT_EQ(run.status, 0) << rule << run.err;
        const Finished stats = run_program({"stats", output, "--json"});
        EXPECT_NE(stats.out.find("\"local_pass\": \"" + rule + "\""), std::string::npos) << stats.out;
        EXPECT_EQ(stats.out.find("\"relative_error_estimate\": null"), std::string::npos) << stats.out;
    }
}

TEST(ProgramLocalPass, OtherMethodsAndUnsupportedOptionsAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), output = folder / "s.h5";
    const std::vector<std::vector<std::string>> wrong = {
        {"--local-pass", "d", "--method", "matrix"},
        {"--local-pass", "f", "--method", "discontinuity"},
        {"--local-pass", "a", "--method", "discontinuity", "--bounces", "0"},
        {"--local-pass", "c", "--method", "discontinuity", "--snapshots", "shots=3"}};
    for (std::vector<std::string> words : wrong) {
        words.insert(words.begin(), {"solve", scene, "-o", output});
        EXPECT_EQ(run_program(words).status, 2) << words.back();
    }
}

}  // namespace exitance::test

#include <gtest/gtest.h>

#include "cli/small_scene.hpp"
#include "support/places.hpp"

namespace exitance::test {
namespace {

/// All light of a solution, exactly: the exported file has the interpolant, and probed points depend on the rest.
std::string light_of(const TemporaryFolder& folder, const std::string& name) {
    const std::string solution = folder / (name + ".h5"), mesh = folder / (name + ".vtkhdf");
    EXPECT_EQ(run_program({"export", solution, "-o", mesh}).status, 0);
    const Finished probe = run_program({"probe", solution, "--points", "-"},
                                       "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n0,2,1,1,0,0\n2.3,0.3,2.5,0,0,-1\n");
    EXPECT_EQ(probe.status, 0) << probe.err;
    return read_text(mesh) + probe.out;
}

std::vector<std::string> solve(const std::string& scene, const TemporaryFolder& folder, const std::string& name,
                               const std::vector<std::string>& more) {
    std::vector<std::string> words{"solve", scene, "-o", folder / (name + ".h5"), "--error", "0.01"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

}  // namespace

TEST(ProgramResume, AStoppedKilledOrLimitedSolveResumesToTheSameBits) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    ASSERT_EQ(run_program(solve(scene, folder, "whole", {})).status, 0);
    for (const auto& [signal, status] : {std::pair{SIGTERM, 143}, {SIGKILL, 1000 + SIGKILL}}) {
        const std::string name = "part" + std::to_string(signal), kept = folder / (name + ".h5.checkpoint");
        RunningProgram run(solve(scene, folder, name, {"--checkpoint-every", "1e-9", "--progress", "json"}));
        while (!std::filesystem::exists(kept)) ASSERT_TRUE(run.wait_for("phase"));
        ASSERT_TRUE(run.wait_for("\"gather\""));
        run.send(signal);
        EXPECT_EQ(run.finish().status, status);
        ASSERT_TRUE(std::filesystem::exists(kept));

        const Finished resumed = run_program(solve(scene, folder, name, {"--resume", "--threads", "1"}));
        EXPECT_EQ(resumed.status, 0) << resumed.err;
        EXPECT_NE(resumed.err.find("continuing from " + kept), std::string::npos) << resumed.err;
        EXPECT_FALSE(std::filesystem::exists(kept)) << "nothing is left to go on with";
        EXPECT_EQ(light_of(folder, name), light_of(folder, "whole"));
    }
    for (int round = 0, status = 4; status != 0 && round < 100; ++round) {
        const std::string seconds = round < 2 ? "0.1" : "60";
        const std::vector<std::string> more{"--checkpoint-every", "0.02", "--resume", "--time-limit", seconds};
        status = run_program(solve(scene, folder, "limited", more)).status;
        EXPECT_TRUE(status == 4 || status == 5 || status == 0) << status;  // 5: no light yet, but a checkpoint
    }
    EXPECT_EQ(light_of(folder, "limited"), light_of(folder, "whole"));
}

TEST(ProgramResume, ACheckpointOfAnotherSolveGivesStatusThree) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const std::vector<std::string> limited{"--checkpoint-every", "1e-9", "--time-limit", "0.08"};
    const int status = run_program(solve(scene, folder, "room", limited)).status;
    ASSERT_TRUE(status == 4 || status == 5) << status;
    if (!std::filesystem::exists(folder / "room.h5.checkpoint")) return;  // too short for the first safe point
    const Finished other = run_program(solve(scene, folder, "room", {"--resume", "--seed", "7"}));
    EXPECT_EQ(other.status, 3);
    EXPECT_NE(other.err.find("--seed was 1 and is 7"), std::string::npos) << other.err;
    EXPECT_NE(other.err.find("room.h5.checkpoint"), std::string::npos) << other.err;
    // Another build may store its state differently. Bytes appended to the program make it another build.
    const std::string build = folder / "exitance";
    std::filesystem::copy_file(test::program(), build);
    std::ofstream(build, std::ios::binary | std::ios::app) << "another";
    RunningProgram rebuilt(solve(scene, folder, "room", {"--resume"}), {}, build);
    const Finished refused = rebuilt.finish();
    EXPECT_EQ(refused.status, 3);
    EXPECT_NE(refused.err.find("the build was"), std::string::npos) << refused.err;
    EXPECT_EQ(run_program(solve(scene, folder, "room", {"--resume"})).status, 0);
}

TEST(ProgramResume, WithoutACheckpointTheSolveStartsWithAMessage) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const Finished run =
        run_program({"solve", scene, "-o", folder / "room.h5", "--error", "0.2", "--resume", "--progress", "none"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("room.h5.checkpoint: starting"), std::string::npos) << run.err;
    EXPECT_EQ(folder.count(), 3u);
}

}  // namespace exitance::test

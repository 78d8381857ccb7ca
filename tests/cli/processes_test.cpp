#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "cli/small_scene.hpp"
#include "exitance/io/solution/solution_file.hpp"

namespace exitance::test {
namespace {

const std::string mpirun = EXITANCE_MPIRUN;  ///< Empty where the build has no MPI.

/// What a run wrote, but for what differs from run to run.
std::string light_in(const TemporaryFolder& folder, const std::string& name) {
    Result<Solution> solution = load_solution(folder / (name + ".h5"));
    if (!solution) return ADD_FAILURE() << solution.error().message, "";
    solution->statistics = {};
    const std::string plain = folder / (name + ".plain");
    EXPECT_TRUE(write_solution(plain, *solution));
    return read_text(plain);
}

class ProgramOfProcesses : public ::testing::Test {
  protected:
    void SetUp() override {
        if (mpirun.empty()) GTEST_SKIP() << "the build has no MPI";
        // More processes than processors, and as root in containers: what mpirun warns of is as wanted here.
        ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1), ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        ::setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1),
            ::setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
        scene = write_small_room(folder);
    }

    std::vector<std::string> solve(const std::string& name, const std::vector<std::string>& more) const {
        std::vector<std::string> words{"solve", scene, "-o", folder / (name + ".h5")};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    static std::vector<std::string> launched(int processes, const std::vector<std::string>& words) {
        std::vector<std::string> all{"-n", std::to_string(processes), EXITANCE_PROGRAM};
        all.insert(all.end(), words.begin(), words.end());
        return all;
    }
    static Finished run_on(int processes, const std::vector<std::string>& words) {
        return RunningProgram(launched(processes, words), {}, mpirun).finish();
    }

    TemporaryFolder folder;
    std::string scene;
};

/// The process that `parent` has started last.
pid_t last_child(pid_t parent) {
    const std::string number = std::to_string(parent);
    std::istringstream children(read_text("/proc/" + number + "/task/" + number + "/children"));
    pid_t last = 0;
    for (pid_t child; children >> child;) last = child;
    return last > 0 ? last : parent;
}

/// How often `text` stands in `all`.
std::size_t times(const std::string& all, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++count;
    return count;
}

}  // namespace

TEST_F(ProgramOfProcesses, WriteTheFileThatOneWrites) {
    const std::vector<std::string> forms[] = {{"--error", "0.1"},
                                              {"--error", "0.05", "--method", "matrix", "--basis", "linear"}};
    for (const std::vector<std::string>& form : forms) {
        ASSERT_EQ(run_program(solve("one", form)).status, 0);
        double bytes_of_two = 0, messages_of_two = 0;
        const bool is_linear = form.size() > 2;  // of which one number is enough
        for (int processes = is_linear ? 3 : 2; processes <= (is_linear ? 3 : 4); ++processes) {
            std::vector<std::string> words = form;
            words.insert(words.end(), {"--json", "--threads", processes == 2 ? "2" : "1"});
            const Finished run = run_on(processes, solve("several", words));
            EXPECT_EQ(run.status, 0) << run.err;
            EXPECT_NE(run.out.find("\"processes\": " + std::to_string(processes)), std::string::npos) << run.out;
            EXPECT_EQ(times(run.out, "\"method\""), 1u) << "only one of them speaks";
            Result<Solution> written = load_solution(folder / "several.h5");
            ASSERT_TRUE(written);
            std::filesystem::remove(folder / "one.plain");
            EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one")) << processes << " processes";
            // What one process would hand on goes to all others: so many bytes and messages, and no other ones.
            const double bytes = written->statistics.figures["message_bytes_solve"],
                         messages = written->statistics.figures["messages_solve"], p = processes;
            if (processes == 2) bytes_of_two = bytes, messages_of_two = messages;
            EXPECT_GT(bytes, 0);
            if (is_linear) continue;
            EXPECT_EQ(bytes, (p - 1) * bytes_of_two);
            EXPECT_EQ(messages, p * (p - 1) / 2 * messages_of_two);
        }
    }
}

/// A limit too low for one process alone is enough for each of two on a node, where what both hold stands once and
/// counts half for each.
TEST_F(ProgramOfProcesses, CountTheirShareOfCommonMemoryAgainstTheirLimit) {
    const std::vector<std::string> error{"--error", "0.1"};
    ASSERT_EQ(run_program(solve("one", error)).status, 0);
    const auto under = [&](int mib) {
        return solve("several", {"--error", "0.1", "--memory-limit", std::to_string(mib) + "M"});
    };
    const Finished tight = run_program(under(1));
    EXPECT_EQ(tight.status, 5) << tight.err;
    const std::string before = "--memory-limit: ";
    const std::size_t at = tight.err.find(before);
    ASSERT_NE(at, std::string::npos) << tight.err;
    const int limit = std::stoi(tight.err.substr(at + before.size())) - 2;  // below what is in use
    EXPECT_EQ(run_program(under(limit)).status, 5);
    const Finished two = run_on(2, under(limit));
    EXPECT_EQ(two.status, 0) << two.err;
    EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one"));
    EXPECT_EQ(run_on(2, under(1)).status, 5);
}

TEST_F(ProgramOfProcesses, RefuseWhatOneAloneCanDo) {
    const Finished method = run_on(2, solve("none", {"--method", "progressive"}));
    EXPECT_EQ(method.status, 2);
    EXPECT_EQ(times(method.err, "progressive does not run over several processes"), 1u) << method.err;
    EXPECT_NE(method.err.find("matrix does"), std::string::npos) << method.err;
    const Finished verb = run_on(2, {"check", scene});
    EXPECT_EQ(verb.status, 2);
    EXPECT_NE(verb.err.find("only `solve`"), std::string::npos) << verb.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "none.h5"));
}

TEST_F(ProgramOfProcesses, FailTogetherAndSaySoOnce) {
    const std::string broken = write_broken_scene(folder);
    const Finished input = run_on(3, {"solve", broken, "-o", folder / "broken.h5"});
    EXPECT_EQ(input.status, 3);
    EXPECT_EQ(times(input.err, "error: "), 1u) << input.err;
    const Finished output = run_on(2, {"solve", scene, "-o", folder / "nowhere/room.h5"});
    EXPECT_EQ(output.status, 5);
    EXPECT_EQ(times(output.err, "error: "), 1u) << output.err;
}

TEST_F(ProgramOfProcesses, TakeAMethodThatRunsOverThemWhereTheirChoiceWouldNot) {
    const std::vector<std::string> fine{"--error-interpolant", "0.01", "--time-limit", "0.5"};
    const Finished run = run_on(2, solve("auto", fine));
    EXPECT_TRUE(run.status == 0 || run.status == 4) << run.err;
    EXPECT_NE(run.err.find("does not run over processes"), std::string::npos) << run.err;
}

TEST_F(ProgramOfProcesses, StopTogetherWhenTimeIsUp) {
    const Finished run = run_on(3, solve("limited", {"--error", "0.001", "--time-limit", "0.4", "--json"}));
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_TRUE(load_solution(folder / "limited.h5"));
}

TEST_F(ProgramOfProcesses, GoOnFromACheckpointInAnotherNumber) {
    const std::string error = "0.02";
    ASSERT_EQ(run_program(solve("one", {"--error", error})).status, 0);
    const std::string kept = folder / "several.h5.checkpoint";
    int processes = 3;
    for (const int signal : {SIGKILL, SIGTERM}) {
        RunningProgram run(launched(processes--, solve("several", {"--error", error, "--checkpoint-every", "1e-9",
                                                                   "--resume", "--progress", "json"})),
                           {}, mpirun);
        // The last of the processes that mpirun has started ends, and with it all.
        while (!std::filesystem::exists(kept)) ASSERT_TRUE(run.wait_for("phase"));
        ASSERT_TRUE(run.wait_for("\"gather\""));
        ASSERT_EQ(kill(last_child(run.process()), signal), 0);
        const int status = run.finish().status;
        EXPECT_NE(status, 0);
        EXPECT_TRUE(signal == SIGKILL || status == 143) << status << ": all stop, and the first writes what there is";
        ASSERT_TRUE(std::filesystem::exists(kept));
    }
    const Finished resumed = run_on(4, solve("several", {"--error", error, "--resume"}));
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_EQ(times(resumed.err, "going on from"), 1u) << resumed.err;
    EXPECT_FALSE(std::filesystem::exists(kept));
    EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one"));
}

}  // namespace exitance::test

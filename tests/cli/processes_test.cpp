#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "cli/process_runs.hpp"
#include "cli/small_scene.hpp"
#include "exitance/base/archive.hpp"
#include "exitance/io/solution/solution_file.hpp"

namespace exitance::test {
namespace {

/// The content of a solution, without statistics that differ from run to run.
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
        if (launcher.empty()) GTEST_SKIP() << "the build has no MPI";
        allow_any_processes();
        scene = write_small_room(folder);
    }

    std::vector<std::string> solve(const std::string& name, const std::vector<std::string>& more) const {
        std::vector<std::string> words{"solve", scene, "-o", folder / (name + ".h5")};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    /// Checkpoint files of `several.h5`: the checkpoint, then the parts of processes 1, 2, ...
    std::vector<std::string> kept_files() const {
        std::vector<std::string> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
            if (entry.path().filename().string().starts_with("several.h5.checkpoint"))
                files.push_back(folder / entry.path().filename().string());
        std::sort(files.begin(), files.end());
        return files;
    }
    /// Solves `several.h5` and stops it during the gather.
    void stop_in_the_gather(int processes, const std::string& error) const {
        const std::vector<std::string> words =
            solve("several", {"--error", error, "--checkpoint-every", "1e-9", "--resume", "--progress", "json"});
        RunningProgram run =
            processes == 1 ? RunningProgram(words) : RunningProgram(launched(processes, words), {}, launcher);
        while (!std::filesystem::exists(folder / "several.h5.checkpoint")) ASSERT_TRUE(run.wait_for("phase"));
        ASSERT_TRUE(run.wait_for("\"gather\""));
        if (processes == 1)
            run.send(SIGTERM);
        else
            ASSERT_EQ(kill(last_child(run.process()), SIGTERM), 0);
        EXPECT_EQ(run.finish().status, 143);
    }

    TemporaryFolder folder;
    std::string scene;
};

}  // namespace

TEST_F(ProgramOfProcesses, WriteTheFileThatOneWrites) {
    const std::vector<std::string> forms[] = {{"--error", "0.1"},
                                              {"--error", "0.1", "--method", "hierarchical", "--keep-links"},
                                              {"--error", "0.05", "--method", "matrix", "--basis", "linear"}};
    for (const std::vector<std::string>& form : forms) {
        ASSERT_EQ(run_program(solve("one", form)).status, 0);
        double bytes_of_two = 0, messages_of_two = 0, fetched_of_four = 0, fetches_of_four = 0;
        const bool is_linear = form.back() == "linear";  // one number of processes is enough for linear elements
        for (int processes = is_linear ? 3 : 2; processes <= (is_linear ? 3 : 4); ++processes) {
            std::vector<std::string> words = form;
            words.insert(words.end(), {"--json", "--threads", processes == 2 ? "2" : "1"});
            const Finished run = run_on(processes, solve("several", words));
            EXPECT_EQ(run.status, 0) << run.err;
            EXPECT_NE(run.out.find("\"processes\": " + std::to_string(processes)), std::string::npos) << run.out;
            EXPECT_EQ(times(run.out, "\"method\""), 1u) << "only one of them speaks";
            Result<Solution> written = load_solution(folder / "several.h5");
            ASSERT_TRUE(written);
            EXPECT_EQ(written->links.links.empty(), form.back() != "--keep-links");
            std::filesystem::remove(folder / "one.plain");
            EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one")) << processes << " processes";
            // Each process sends its results to all others, so bytes and messages have exactly these numbers.
            std::map<std::string, double>& figures = written->statistics.figures;
            const double bytes = figures["message_bytes_solve"], messages = figures["messages_solve"], p = processes;
            if (processes == 2) bytes_of_two = bytes, messages_of_two = messages;
            EXPECT_GT(bytes, 0);
            // Fetched values are sent only to the process that reads them. The run of two computes the numbers for
            // four.
            EXPECT_GT(figures["message_bytes_fetch"], 0);
            if (processes == 2) {
                fetched_of_four = figures["message_bytes_fetch_of_twice"];
                fetches_of_four = figures["messages_fetch_of_twice"];
            } else if (processes == 4) {
                EXPECT_EQ(figures["message_bytes_fetch"], fetched_of_four);
                EXPECT_EQ(figures["messages_fetch"], fetches_of_four);
            }
            for (const char* part : {"dealt", "repeated"})
                EXPECT_GT(written->statistics.figures[part + std::string("_processor_seconds")], 0);
            double dealt = 0;
            for (const auto& [name, seconds] : written->statistics.figures)
                if (name.starts_with("dealt_seconds_")) dealt += seconds;
            EXPECT_GE(p * written->statistics.figures["longest_processor_seconds"], 0.999 * dealt)
                << "nobody takes longest for less than all do on average; a nanosecond is lost at every meeting";
            if (is_linear) continue;
            EXPECT_EQ(bytes, (p - 1) * bytes_of_two);
            EXPECT_EQ(messages, p * (p - 1) / 2 * messages_of_two);
        }
    }
}

/// A limit that is too low for a single process is enough for each of two on a node, since half of their shared memory
/// counts for each.
TEST_F(ProgramOfProcesses, CountTheirShareOfSharedMemoryForTheirLimit) {
    const std::vector<std::string> error{"--error", "0.1"};
    ASSERT_EQ(run_program(solve("one", error)).status, 0);
    const auto under = [&](int mib) {
        return solve("several", {"--error", "0.1", "--memory-limit", std::to_string(mib) + "M"});
    };
    // The smallest limit with which the scene can be read is too low for a solve: for its coarsest mesh (exit code 5),
    // or, when less memory happens to be in use than in the run before, for the requested error (exit code 4).
    const std::regex in_use(R"((\d+) MiB (are )?in use)");
    int limit = 1;
    for (bool is_planned = false; !is_planned;) {
        const Finished tight = run_program(under(limit));
        if (tight.status == 4) break;
        ASSERT_EQ(tight.status, 5) << tight.err;
        std::smatch found;
        ASSERT_TRUE(std::regex_search(tight.err, found, in_use)) << tight.err;
        is_planned = tight.err.find("needs about") != std::string::npos;
        limit = is_planned ? std::stoi(found[1]) : std::max(limit + 1, std::stoi(found[1]));
    }
    limit -= 2;  // a margin for the memory in use, which differs from run to run
    EXPECT_NE(run_program(under(limit)).status, 0);
    const Finished two = run_on(2, under(limit));
    EXPECT_EQ(two.status, 0) << two.err;
    EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one"));
    EXPECT_EQ(run_on(2, under(1)).status, 5);
}

TEST_F(ProgramOfProcesses, RejectWhatOnlyASingleProcessSupports) {
    const Finished method = run_on(2, solve("none", {"--method", "progressive"}));
    EXPECT_EQ(method.status, 2);
    EXPECT_EQ(times(method.err, "progressive does not run over several processes"), 1u) << method.err;
    EXPECT_NE(method.err.find("use matrix"), std::string::npos) << method.err;
    const Finished judged = run_on(2, solve("none", {"--method", "hierarchical", "--clusters", "on"}));
    EXPECT_EQ(judged.status, 2);
    EXPECT_NE(judged.err.find("links that are refined pair by pair"), std::string::npos) << judged.err;
    const Finished verb = run_on(2, {"check", scene});
    EXPECT_EQ(verb.status, 2);
    EXPECT_NE(verb.err.find("which only solve, probe,"), std::string::npos) << verb.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "none.h5"));
}

TEST_F(ProgramOfProcesses, FailTogetherWithOneMessage) {
    const std::string broken = write_broken_scene(folder);
    const Finished input = run_on(3, {"solve", broken, "-o", folder / "broken.h5"});
    EXPECT_EQ(input.status, 3);
    EXPECT_EQ(times(input.err, "error: "), 1u) << input.err;
    const Finished output = run_on(2, {"solve", scene, "-o", folder / "nowhere/room.h5"});
    EXPECT_EQ(output.status, 5);
    EXPECT_EQ(times(output.err, "error: "), 1u) << output.err;
}

TEST_F(ProgramOfProcesses, ChooseAMethodThatSupportsSeveralProcesses) {
    const std::vector<std::string> fine{"--error-interpolant", "0.01", "--time-limit", "0.5"};
    const Finished run = run_on(2, solve("auto", fine));
    EXPECT_TRUE(run.status == 0 || run.status == 4 || run.status == 5) << run.err;
    EXPECT_NE(run.err.find("does not run over processes"), std::string::npos) << run.err;
}

TEST_F(ProgramOfProcesses, StopTogetherAtTheTimeLimit) {
    const Finished run = run_on(3, solve("limited", {"--error", "0.0003", "--time-limit", "4", "--json"}));
    EXPECT_EQ(run.status, 4) << run.err;
    Result<Solution> written = load_solution(folder / "limited.h5");
    ASSERT_TRUE(written);
    EXPECT_EQ(written->statistics.stopped_by, StopReason::time_limit);
    for (const std::string& warning : written->statistics.warnings)
        EXPECT_EQ(warning.find("was stopped"), std::string::npos) << warning;
    // An attempt is stopped, or the next one is expected not to fit into the time that is left.
    EXPECT_NE(run.err.find("the time limit"), std::string::npos) << run.err;
}

TEST_F(ProgramOfProcesses, ResumeFromACheckpointOfAnotherNumberOfProcesses) {
    const std::string error = "0.02";
    ASSERT_EQ(run_program(solve("one", {"--error", error})).status, 0);
    const std::string kept = folder / "several.h5.checkpoint";
    int processes = 3;
    for (const int signal : {SIGKILL, SIGTERM}) {
        RunningProgram run(launched(processes--, solve("several", {"--error", error, "--checkpoint-every", "1e-9",
                                                                   "--resume", "--progress", "json"})),
                           {}, launcher);
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
    EXPECT_EQ(times(resumed.err, "continuing from"), 1u) << resumed.err;
    EXPECT_TRUE(kept_files().empty());
    EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one"));
}

TEST_F(ProgramOfProcesses, WritePartsThatAnyNumberOfProcessesCanResume) {
    const std::string error = "0.02";
    ASSERT_EQ(run_program(solve("one", {"--error", error})).status, 0);
    for (const auto& [before, after] : {std::pair{1, 2}, {2, 1}, {3, 2}, {4, 3}}) {
        SCOPED_TRACE(std::to_string(before) + " processes, then " + std::to_string(after));
        stop_in_the_gather(before, error);
        const std::vector<std::string> files = kept_files();
        ASSERT_EQ(files.size(), static_cast<std::size_t>(before)) << "and none of those kept before";
        std::uintmax_t least = ~std::uintmax_t(0), most = 0;
        for (const std::string& file : files) {
            const std::uintmax_t size = std::filesystem::file_size(file);
            least = std::min(least, size), most = std::max(most, size);
        }
        EXPECT_LE(most - least, 2 * DealtBytes::block) << "dealt out by blocks; the first one says what it is of";
        const Finished resumed = run_on(after, solve("several", {"--error", error, "--resume"}));
        EXPECT_EQ(resumed.status, 0) << resumed.err;
        EXPECT_EQ(times(resumed.err, "continuing from"), 1u) << resumed.err;
        EXPECT_TRUE(kept_files().empty());
        std::filesystem::remove(folder / "one.plain"), std::filesystem::remove(folder / "several.plain");
        EXPECT_TRUE(light_in(folder, "several") == light_in(folder, "one"));
        std::filesystem::remove(folder / "several.h5");
    }
}

TEST_F(ProgramOfProcesses, RejectACheckpointWithMissingOrOtherParts) {
    const std::string error = "0.02";
    stop_in_the_gather(3, error);
    ASSERT_EQ(kept_files().size(), 3u);
    const std::string older = read_text(kept_files()[1]);
    stop_in_the_gather(3, error);
    const std::vector<std::string> files = kept_files();
    ASSERT_EQ(files.size(), 3u);
    const std::string whole = read_text(files[0]), first = read_text(files[1]), second = read_text(files[2]);
    const auto expect_refused = [&](int processes, const std::string& file, const std::string& why) {
        const Finished run = run_on(processes, solve("several", {"--error", error, "--resume"}));
        EXPECT_EQ(run.status, 3) << run.err;
        EXPECT_EQ(times(run.err, "error: " + file + ": "), 1u) << run.err;
        EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
        EXPECT_NE(run.err.find("without --resume"), std::string::npos) << run.err;
    };
    write_text(files[1], first.substr(0, first.size() - 1));
    expect_refused(1, files[1], std::to_string(first.size() - 1) + " bytes");
    std::string other = first;
    other[first.size() / 2] ^= 1;
    write_text(files[1], other);
    expect_refused(2, files[1], "a part of another checkpoint");
    std::filesystem::remove(files[1]);
    expect_refused(4, files[1], "is missing");
    write_text(files[1], first), write_text(files[2], first + second);
    expect_refused(2, files[2], std::to_string(first.size() + second.size()) + " bytes");
    write_text(files[2], second), write_text(files[0], whole.substr(0, whole.size() / 2));
    expect_refused(2, files[0], "is damaged");
    write_text(files[0], whole);
    EXPECT_EQ(run_on(2, solve("several", {"--error", error, "--resume"})).status, 0);
    EXPECT_TRUE(kept_files().empty());
}

}  // namespace exitance::test

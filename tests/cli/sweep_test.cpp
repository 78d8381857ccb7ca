// Sweeps of variants by `exitance sweep`: states, sharing of steps, failures, kills, processes side by side.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <deque>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <thread>

#include "cli/room_sweep.hpp"
#include "exitance/base/sanitizers.hpp"

namespace exitance::test {
namespace {

namespace fs = std::filesystem;

/// Names in the folder of steps: of finished steps, and of everything else.
std::pair<std::set<std::string>, std::set<std::string>> steps_in(const TemporaryFolder& folder) {
    std::pair<std::set<std::string>, std::set<std::string>> out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "plan.sweep/steps")) {
        const std::string name = entry.path().filename();
        const bool is_finished = name.size() == 40 && name.find('.') == std::string::npos;
        (is_finished ? out.first : out.second).insert(name);
    }
    return out;
}

}  // namespace

TEST(ProgramSweep, ListsRunsAndCollectsVariants) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder);
    EXPECT_EQ(sweep(plan, {"--list"}).out,
              "variant  state  wall  lamp\n1        to do  0.3   0.5\n2        to do  0.3   1\n"
              "3        to do  0.6   0.5\n4        to do  0.6   1\n");
    const Finished one = sweep(plan, {"--run", "2"});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(states_of(plan), "to do,done,to do,to do");
    const Finished partial = sweep(plan, {"--collect"});
    EXPECT_EQ(partial.status, 4);
    EXPECT_NE(partial.err.find("warning: variant 1 is missing: to do"), std::string::npos) << partial.err;
    const Finished all = sweep(plan, {"--local", "2", "--collect", "--json"});
    EXPECT_EQ(all.status, 0) << all.err;
    EXPECT_EQ(report_of(all)["done"], 4);
    EXPECT_EQ(report_of(all)["steps_run"], 12 - 4);
    std::istringstream lines(read_text(folder / "plan.sweep/results.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "variant,state,wall,lamp,mean,E_1,E_2,surfaces");
    double mean[4], first, second;
    for (int i = 0; i < 4; ++i) {
        std::getline(lines, line);
        double wall, lamp;
        int number;
        ASSERT_EQ(std::sscanf(line.c_str(), "%d,done,%lf,%lf,%lf,%lf,%lf,7", &number, &wall, &lamp, mean + i, &first,
                              &second),
                  6)
            << line;
        EXPECT_EQ(number, i + 1);
        EXPECT_NEAR(mean[i], (first + second) / 2, 1e-9 * mean[i]);
    }
    // All light is of the lamp, so that half of it gives half of the light. Files have 10 digits.
    EXPECT_NEAR(mean[1], 2 * mean[0], 1e-5 * mean[1]);
    EXPECT_NEAR(mean[3], 2 * mean[2], 1e-5 * mean[3]);
    EXPECT_GT(mean[3], 1.05 * mean[1]) << "brighter walls";
    EXPECT_TRUE(fs::exists(folder / "plan.sweep/variants/0003/light.csv"));
    EXPECT_TRUE(fs::exists(folder / "plan.sweep/results.h5"));
}

TEST(ProgramSweep, FinishedVariantsAreNotRunAgainUnlessTheirInputsChange) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder);
    ASSERT_EQ(sweep(plan, {"--local", "2"}).status, 0);
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 0);
    EXPECT_EQ(report_of(sweep(plan, {"--run", "3", "--json"}))["steps_run"], 0);
    const std::string before = table_of(folder);

    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,1,0,0,0,1\n");
    EXPECT_EQ(states_of(plan), "to do,to do,to do,to do");
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 4) << "only probe reads the points";
    EXPECT_NE(table_of(folder), before);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n2,1,0,0,0,1\n");
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 0) << "the old results are kept";
    EXPECT_EQ(table_of(folder), before);
    write_text(folder / "plan.toml", with(plan_of_room, "[0.5, 1]", "[0.5, 1, 2]"));
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 4) << "two mixes and two probes";
    write_text(folder / "room.mtl", read_text(folder / "room.mtl") + "# changed\n");
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 2 + 2 + 6 + 6);
}

TEST(ProgramSweep, FailuresAreReportedAndTheRestGoesOn) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, with(plan_of_room, "wall = [0.3, 0.6]", "wall = [0.3, 1.5]"));
    const Finished run = sweep(plan, {"--local", "2", "--json"});
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_EQ(report_of(run)["done"], 2);
    EXPECT_EQ(report_of(run)["failed"], 2);
    EXPECT_NE(run.err.find("error: variant 3: solve: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("not in [0, 1)"), std::string::npos) << run.err;
    EXPECT_EQ(states_of(plan), "done,done,failed,failed");
    EXPECT_EQ(sweep(plan, {"--run", "4"}).status, 1);
    const Finished table = sweep(plan, {"--collect", "-o", folder / "t.csv"});
    EXPECT_EQ(table.status, 4);
    EXPECT_NE(read_text(folder / "t.csv").find("\n4,failed,1.5,1,,,,\n"), std::string::npos)
        << read_text(folder / "t.csv");
}

/// The result of a step whose input was edited while it ran may be of either content, so it is not kept.
TEST(ProgramSweep, AResultOfAnEditedInputIsNotKept) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder);
    RunningProgram job({"sweep", plan, "--local", "1"});
    for (int glances = 0; states_of(plan).find("running") == std::string::npos; ++glances) ASSERT_LT(glances, 2000);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n3,1,0,0,0,1\n3,2,0,0,0,1\n");
    const Finished edited = job.finish();
    if (edited.status != 0) {  // else the edit came before the points were hashed
        EXPECT_NE(edited.err.find("points.csv changed after its content was hashed"), std::string::npos) << edited.err;
    }
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    const std::string table = table_of(folder);
    fs::remove_all(folder / "plan.sweep");
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    EXPECT_EQ(table_of(folder), table);
}

TEST(ProgramSweep, AnAcceptedExitStatusIsNoFailure) {
    const TemporaryFolder folder;
    const std::string text = "[[step]]\nrun = \"check broken.obj --json\"\n";
    const std::string plan = write_plan(folder, text);
    write_text(folder / "broken.obj", "v 0 0\nf 1 2 3\n");
    ASSERT_EQ(sweep(plan, {"--run", "1"}).status, 1);
    write_text(plan, text + "accept = [0, 3]\n");
    EXPECT_EQ(sweep(plan, {"--run", "1"}).status, 0);
    EXPECT_EQ(states_of(plan), "done");
    write_text(plan, text);
    EXPECT_EQ(states_of(plan), "to do") << "its status is no longer accepted";
}

TEST(ProgramSweep, WrongPlansAreErrorsThatNameTheLineAndTheKey) {
    const TemporaryFolder folder;
    const auto error_of = [&](const std::string& text) {
        const Finished run = sweep(write_plan(folder, text), {"--list"});
        EXPECT_EQ(run.status, 3) << run.err;
        return run.err.substr(run.err.find("plan.toml"));
    };
    EXPECT_EQ(
        error_of(with(plan_of_room, "--method matrix", "--methd matrix"))
            .find("plan.toml:8: 'run' of step 'solve': '--methd' is not a known option or argument\nhint: did you mean "
                  "--method?"),
        0u);
    EXPECT_EQ(
        error_of("\n[[step]]\nrun = \"mxi a.h5\"\n").find("plan.toml:3: 'run' of step 'mxi': there is no verb 'mxi'"),
        0u);
    EXPECT_EQ(error_of("[[step]]\nrun = \"view room.obj\"\n").find("plan.toml:2: 'run' of step 'view': 'view' cannot"),
              0u);
    EXPECT_EQ(error_of("[[vary]\n").find("plan.toml:1: "), 0u);
    EXPECT_EQ(sweep(folder / "none.toml", {"--list"}).status, 3);
    EXPECT_EQ(sweep(folder / "plan.toml", {}).status, 2);
    write_plan(folder);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--run", "5"}).status, 2);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--run", "0"}).status, 2);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--run", "1", "--local", "2"}).status, 2);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--list", "--collect"}).status, 2);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--list", "-o", "a.csv"}).status, 2);
    EXPECT_EQ(sweep(folder / "plan.toml", {"--collect", "-o", "a.txt"}).status, 2);
}

/// Kills processes of one sweep at random times, 30 in all. Afterwards the sweep finishes with the table of one that
/// was never disturbed, and no step is there twice or in part.
TEST(ProgramSweep, ThirtyKilledJobsLoseNothingAndCountNothingTwice) {
    const TemporaryFolder undisturbed, folder;
    ASSERT_EQ(sweep(write_plan(undisturbed), {"--local", "2"}).status, 0);
    const std::string table = table_of(undisturbed);
    const std::string plan = write_plan(folder);
    std::mt19937 random(60);
    for (int kills = 0; kills < 30; ++kills) {
        // A sweep that is done begins again, so that every kill may meet work.
        if (kills % 10 == 9) fs::remove_all(folder / "plan.sweep");
        std::vector<std::string> words{"sweep", plan, "--progress", "none"};
        if (kills % 3 == 0)
            words.insert(words.end(), {"--local", "2"});
        else
            words.insert(words.end(), {"--run", std::to_string(1 + kills % 4)});
        RunningProgram job(words);
        std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 250)(random)));
        job.send(SIGKILL);
        job.finish();
    }
    const Finished rest = sweep(plan, {"--local", "2"});
    EXPECT_EQ(rest.status, 0) << rest.err;
    EXPECT_EQ(table_of(folder), table);
    EXPECT_EQ(steps_in(folder).first, steps_in(undisturbed).first);
    for (const std::string& name : steps_in(folder).second)
        EXPECT_EQ(name.find(".failed"), std::string::npos) << "a kill is no failure: " << name;
    EXPECT_EQ(report_of(sweep(plan, {"--local", "2", "--json"}))["steps_run"], 0);
}

/// Processes side by side share the work: every step is run by one of them.
TEST(ProgramSweep, ConcurrentSweepsMakeTheSameTableAndRunEveryStepOnce) {
    const TemporaryFolder alone, folder;
    ASSERT_EQ(sweep(write_plan(alone), {"--local", "1"}).status, 0);
    const std::string plan = write_plan(folder);
    std::deque<RunningProgram> jobs;  // a started program cannot be moved
    for (int i = 0; i < 2; ++i) jobs.emplace_back(std::vector<std::string>{"sweep", plan, "--local", "2", "--json"});
    for (const char* k : {"1", "2", "3", "4"})
        jobs.emplace_back(std::vector<std::string>{"sweep", plan, "--run", k, "--json"});
    int steps = 0;
    for (RunningProgram& job : jobs) {
        const Finished run = job.finish();
        EXPECT_EQ(run.status, 0) << run.err;
        steps += report_of(run)["steps_run"].get<int>();
    }
    EXPECT_EQ(steps, 12);
    EXPECT_EQ(table_of(folder), table_of(alone));
}

TEST(ProgramSweep, SignalsAndTimeLimitsEndItCleanly) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(
        folder, with(with(plan_of_room, "--error 0.5", "--error 0.0001"), "--mesh-size 1", "--mesh-size 0.02"));
    RunningProgram job({"sweep", plan, "--local", "2", "-v", "--progress", "plain"});
    for (int glances = 0; states_of(plan).find("running") == std::string::npos; ++glances) ASSERT_LT(glances, 2000);
    job.send(SIGTERM);
    const Finished stopped = job.finish();
    EXPECT_EQ(stopped.status, 143) << stopped.err;
    EXPECT_EQ(states_of(plan), "to do,to do,to do,to do");
    const Finished limited = sweep(plan, {"--local", "2", "--time-limit", "0.5"});
    EXPECT_EQ(limited.status, 4) << limited.err;
    EXPECT_NE(limited.err.find("stopped by the time limit: the same command continues"), std::string::npos);
    for (const std::string& name : steps_in(folder).second) EXPECT_EQ(name, ".guard") << "no locks or parts are left";
}

/// The recipe of docs/sweeps.md: one solve with light groups, then mixes. Each variant is compared with its own solve.
TEST(ProgramSweep, MixedVariantsAgreeWithSolvesOfTheirOwn) {
    const TemporaryFolder folder;
    write_small_room(folder);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,2.5,0,0,0,1\n0.5,2,2.5,0,0,-1\n");
    const std::string vary = "[[vary]]\nlamp = [0.25, 1]\nwall = [0.3, 0.7]\n";
    const std::string output = "[[output]]\nname = \"E\"\nfile = \"l.csv\"\ncolumn = \"E_g\"\ntake = \"all\"\n";
    write_text(folder / "mix.toml", vary +
                                        "[[step]]\nrun = \"solve room.obj -o {dir}/a.h5 --error 0.01 --light-groups\"\n"
                                        "[[step]]\nrun = \"mix {dir}/a.h5 lamp={lamp} --reflectance "
                                        "grey={wall},{wall},{wall} -o {dir}/b.h5\"\n[[step]]\nrun = \"probe {dir}/b.h5 "
                                        "--points points.csv -o {dir}/l.csv\"\n" +
                                        output);
    std::string materials = read_text(folder / "room.mtl");
    materials = with(with(materials, "Kd 0.5 0.4 0.3", "Kd {{wall}} {{wall}} {{wall}}"), "Ke 10 10 10",
                     "Ke {{Ke}} {{Ke}} {{Ke}}");
    write_text(folder / "room.mtl", materials);
    write_text(folder / "solve.toml", with(vary, "lamp = [0.25, 1]", "Ke = [2.5, 10]") +
                                          "[scene]\ntemplate = [\"room.obj\", \"room.mtl\"]\n[[step]]\nrun = \"solve "
                                          "{scene} -o {dir}/b.h5 --error 0.01\"\n[[step]]\nrun = \"probe {dir}/b.h5 "
                                          "--points points.csv -o {dir}/l.csv\"\n" +
                                          output);
    write_small_room(folder, "unused");
    // The scene of the mixed sweep is the unchanged room.
    write_text(folder / "mix.toml", with(read_text(folder / "mix.toml"), "solve room.obj", "solve unused.obj"));
    std::vector<std::vector<double>> rows[2];
    for (int i = 0; i < 2; ++i) {
        const std::string name = i == 0 ? "mix" : "solve";
        const Finished run = sweep(folder / (name + ".toml"), {"--local", "2", "--collect"});
        ASSERT_EQ(run.status, 0) << run.err;
        std::istringstream lines(read_text(folder / (name + ".sweep/results.csv")));
        std::string line;
        std::getline(lines, line);
        while (std::getline(lines, line)) {
            std::vector<double>& row = rows[i].emplace_back(3);
            ASSERT_EQ(std::sscanf(line.c_str(), "%*d,done,%*f,%*f,%lf,%lf,%lf", &row[0], &row[1], &row[2]), 3) << line;
        }
    }
    ASSERT_EQ(rows[0].size(), 4u);
    double square = 0, difference = 0;
    for (std::size_t v = 0; v < 4; ++v)
        for (std::size_t p = 0; p < 3; ++p) {
            square += rows[1][v][p] * rows[1][v][p];
            difference += std::pow(rows[0][v][p] - rows[1][v][p], 2);
        }
    // Both have an error of 1%; three points may be three times as far off as the mean of all.
    EXPECT_LT(std::sqrt(difference / square), 3 * std::hypot(0.01, 0.01));
}

/// The scripts of examples/cluster, as far as their programs are installed.
class ClusterScripts : public testing::Test {
  protected:
    static bool has(const std::string& program) {
        return RunningProgram({"-c", "command -v " + program}, {}, "/bin/bash").finish().status == 0;
    }
    Finished run_script(const std::string& name) {
        plan_ = write_plan(folder_);
        return RunningProgram(
                   {"-c", "PATH='" + fs::path(program()).parent_path().string() + "':$PATH; cd '" + (folder_ / "") +
                              "' && bash '" + source_folder() + "/examples/cluster/" + name + "' plan.toml 2"},
                   {}, "/bin/bash")
            .finish();
    }
    /// All variants are done, with the table of a sweep on one machine.
    void expect_finished() {
        EXPECT_EQ(states_of(plan_), "done,done,done,done");
        const TemporaryFolder alone;
        EXPECT_EQ(sweep(write_plan(alone), {"--local", "2"}).status, 0);
        EXPECT_EQ(table_of(folder_), table_of(alone));
    }
    TemporaryFolder folder_;
    std::string plan_;
};

TEST_F(ClusterScripts, GnuParallelRunsAllVariants) {
    if (!has("parallel")) GTEST_SKIP() << "GNU parallel is not installed: apt-get install parallel";
    const Finished run = run_script("parallel.sh");
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    expect_finished();
    EXPECT_TRUE(fs::exists(folder_ / "plan.sweep/results.csv"));
}

TEST_F(ClusterScripts, XargsRunsAllVariants) {
    const Finished run = run_script("xargs.sh");
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    expect_finished();
    EXPECT_TRUE(fs::exists(folder_ / "plan.sweep/results.csv"));
}

/// Slurm's array tasks, with the variables that Slurm sets, as plain processes.
TEST_F(ClusterScripts, SlurmArrayTasksRunTheirVariants) {
    plan_ = write_plan(folder_);
    for (int task = 1; task <= 2; ++task) {
        const std::string words = "PATH='" + fs::path(program()).parent_path().string() + "':$PATH; cd '" +
                                  (folder_ / "") + "' && SLURM_ARRAY_TASK_ID=" + std::to_string(task) +
                                  " SLURM_CPUS_PER_TASK=1 PER_TASK=2 bash '" + source_folder() +
                                  "/examples/cluster/slurm_array.sh' plan.toml";
        const Finished run = RunningProgram({"-c", words}, {}, "/bin/bash").finish();
        EXPECT_EQ(run.status, 0) << run.out << run.err;
    }
    expect_finished();
}

TEST_F(ClusterScripts, SnakemakeRunsAllVariants) {
    if (!has("snakemake")) GTEST_SKIP() << "Snakemake is not installed";
    plan_ = write_plan(folder_);
    const Finished run =
        RunningProgram({"-c", "PATH='" + fs::path(program()).parent_path().string() + "':$PATH; cd '" + (folder_ / "") +
                                  "' && snakemake --cores 2 --snakefile '" + source_folder() +
                                  "/examples/cluster/Snakefile' --config plan=plan.toml"},
                       {}, "/bin/bash")
            .finish();
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    expect_finished();
}

TEST_F(ClusterScripts, DaskRunsAllVariantsOnTwoWorkers) {
    if (RunningProgram({"-c", "import dask.distributed"}, {}, "/usr/bin/python3").finish().status != 0)
        GTEST_SKIP() << "dask.distributed is not installed: apt-get install python3-distributed";
    plan_ = write_plan(folder_);
    const Finished run = RunningProgram({"-c", "PATH='" + fs::path(program()).parent_path().string() + "':$PATH; cd '" +
                                                   (folder_ / "") + "' && /usr/bin/python3 '" + source_folder() +
                                                   "/examples/cluster/dask_sweep.py' plan.toml"},
                                        {}, "/bin/bash")
                             .finish();
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    expect_finished();
}

}  // namespace exitance::test

#include <gtest/gtest.h>

#include <filesystem>

#include "cli/process_runs.hpp"
#include "exitance/io/files/folder_lock.hpp"
#include "run_program.hpp"

namespace exitance::test {
namespace {

namespace fs = std::filesystem;

const std::string tiny =
    "title = \"A tube\"\nparameter = \"reflectance\"\ntime_limit = 60\nequal_time = true\n"
    "[[scene]]\nname = \"tube\"\ngenerate = \"tube rho={value} length=2\"\nvalues = [0.3, 0.6]\n"
    "[reference]\npoints = 60\npaths = 32\n"
    "[[row]]\nlabel = \"matrix\"\noptions = \"--method matrix --direct carried --mesh uniform --mesh-size 1 --gather "
    "off "
    "--relaxation gauss-seidel --snapshots rounds\"\n"
    "[[row]]\nlabel = \"Haar\"\noptions = \"--method wavelet --basis haar --direct carried --gather off --oracle bf "
    "--threshold {setting}\"\nsettings = [\"1\"]\nmost = 0.5\n"
    "[[row]]\nlabel = \"wrong\"\noptions = \"--method matrix --basis haar\"\n"
    "[[picture]]\nrow = \"matrix\"\nvalue = 0.3\nat = 1000\noptions = \"--size 32x24\"\n"
    "[[plot]]\nname = \"error\"\nx = \"parameter\"\ny = \"relative_rms_error\"\n"
    "[[conclusion]]\nsays = \"The matrix is run\"\nmeasure = \"largest\"\ny = \"iterations\"\n"
    "where = { row = \"matrix\" }\nleast = 1\n";

std::vector<std::string> lines_of(const std::string& path) {
    std::vector<std::string> lines;
    std::istringstream text(read_text(path));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
}

/// The rows of results.csv without the measured times.
std::string without_times(const std::string& path) {
    std::string out;
    for (const std::string& line : lines_of(path)) {
        int field = 0;
        bool is_quoted = false;
        for (const char c : line) {
            is_quoted ^= c == '"';
            field += c == ',' && !is_quoted;
            if (field != 7 && field != 17) out += c;
        }
        out += "\n";
    }
    return out;
}

TEST(ProgramExperiment, SeveralProcessesDivideTheRuns) {
    if (launcher.empty()) GTEST_SKIP() << "the build has no MPI";
    allow_any_processes();
    const TemporaryFolder folder;
    write_text(folder / "tiny.toml", tiny);
    for (int processes = 1; processes <= 3; ++processes) {
        const std::string output = folder / ("of" + std::to_string(processes));
        const Finished run = run_on(processes, {"experiment", folder / "tiny.toml", "-o", output});
        ASSERT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(times(run.out, "page "), 1u) << run.out;
        EXPECT_EQ(without_times(output + "/results.csv"), without_times(folder / "of1/results.csv"));
        EXPECT_TRUE(fs::exists(output + "/index.html"));
    }
}

TEST(ProgramExperiment, ListsAndPrintsStudies) {
    const Finished list = run_program({"experiment", "list"});
    EXPECT_EQ(list.status, 0);
    for (const char* name : {"blocker", "tube", "complex", "schedules", "cie171"})
        EXPECT_NE(list.out.find(name), std::string::npos) << name;
    const Finished text = run_program({"experiment", "tube", "--print"});
    EXPECT_EQ(text.status, 0);
    EXPECT_NE(text.out.find("[[row]]"), std::string::npos);
}

TEST(ProgramExperiment, RejectsInvalidStudies) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_program({"experiment", "tub", "-o", folder / "x"}).status, 2);
    EXPECT_EQ(run_program({"experiment", "tube"}).status, 2);
    EXPECT_EQ(run_program({"experiment", "tube", "--methods", "nothing", "-o", folder / "x"}).status, 2);
    write_text(folder / "s.toml", "title = 3\n");
    const Finished wrong = run_program({"experiment", folder / "s.toml", "-o", folder / "x"});
    EXPECT_EQ(wrong.status, 3);
    EXPECT_NE(wrong.err.find("s.toml:1"), std::string::npos) << wrong.err;
}

TEST(ProgramExperiment, RunsAStudyAndDoesNotRepeatIt) {
    const TemporaryFolder folder;
    write_text(folder / "s.toml", tiny);
    const Finished first = run_program({"experiment", folder / "s.toml", "-o", folder / "out"});
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_NE(first.out.find("holds"), std::string::npos) << first.out;
    const std::vector<std::string> lines = lines_of(folder / "out/results.csv");
    EXPECT_EQ(lines[0],
              "study,scene,parameter,method,basis,setting,checkpoint,seconds,relative_rms_error,"
              "raw_relative_rms_error,elements,links,rays,memory_bytes,status,link_bytes,element_bytes,peak_bytes");
    const std::string all = read_text(folder / "out/results.csv");
    for (const char* status : {"on the way", "done", "not run: beyond 0.5", "failed: "})
        EXPECT_NE(all.find(status), std::string::npos) << status;
    EXPECT_TRUE(fs::exists(folder / "out/pictures/1_light.png")) << "of the last solution on the way";
    const std::string page = read_text(folder / "out/index.html");
    EXPECT_NE(page.find("The matrix is run"), std::string::npos);
    EXPECT_NE(page.find("exitance solve scenes/tube_0.3.obj"), std::string::npos);

    std::map<std::string, fs::file_time_type> made;
    for (const auto& entry : fs::directory_iterator(folder / "out/runs")) made[entry.path()] = entry.last_write_time();
    ASSERT_EQ(run_program({"experiment", folder / "s.toml", "-o", folder / "out"}).status, 0);
    for (const auto& entry : fs::directory_iterator(folder / "out/runs"))
        EXPECT_EQ(made[entry.path()], entry.last_write_time());
    EXPECT_EQ(read_text(folder / "out/results.csv"), all);
}

TEST(ProgramExperiment, DoesNotRepeatTheScenesOfATable) {
    const TemporaryFolder folder;
    const std::string text =
        "title = \"Faces\"\ntable = \"premesh\"\n[[scene]]\nname = \"boxes\"\ngenerate = \"boxes\"\n";
    write_text(folder / "s.toml", text);
    ASSERT_EQ(run_program({"experiment", folder / "s.toml", "-o", folder / "out"}).status, 0);
    // Stored rows of a scene are reused without a new run.
    std::string kept;
    for (const auto& entry : fs::directory_iterator(folder / "out/runs")) kept = entry.path().string();
    std::string rows = read_text(kept);
    const std::size_t at = rows.find("longest first");
    ASSERT_NE(at, std::string::npos) << rows;
    rows.replace(at, 13, "kept");
    write_text(kept, rows);
    write_text(folder / "s.toml", text + "[[scene]]\nname = \"table\"\ngenerate = \"table\"\n");
    ASSERT_EQ(run_program({"experiment", folder / "s.toml", "-o", folder / "out"}).status, 0);
    const std::string all = read_text(folder / "out/results.csv");
    EXPECT_NE(all.find("boxes,"), std::string::npos);
    EXPECT_NE(all.find(",kept,"), std::string::npos);
    EXPECT_NE(all.find("table,"), std::string::npos);
}

TEST(ProgramExperiment, DoesNotUseAFolderOfAnotherActiveRun) {
    const TemporaryFolder folder;
    write_text(folder / "s.toml", tiny);
    {
        const Result<FolderLock> other = FolderLock::take(folder / "");
        ASSERT_TRUE(other);
        const Finished second = run_program({"experiment", folder / "s.toml", "-o", folder / ""});
        EXPECT_NE(second.status, 0);
        EXPECT_NE(second.err.find("another run works in this folder"), std::string::npos) << second.err;
        EXPECT_FALSE(fs::exists(folder / "runs"));
    }
    EXPECT_TRUE(FolderLock::take(folder / ""));
}

TEST(ProgramExperiment, ResumesAfterAStop) {
    const TemporaryFolder folder;
    write_text(folder / "s.toml", tiny);
    ASSERT_EQ(run_program({"experiment", folder / "s.toml", "-o", folder / "whole"}).status, 0);
    RunningProgram stopped({"experiment", folder / "s.toml", "-o", folder / "parts", "--progress", "plain"});
    for (int i = 0; i < 2000 && (!fs::exists(folder / "parts/runs") || fs::is_empty(folder / "parts/runs")); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    stopped.send(SIGTERM);
    EXPECT_EQ(stopped.finish().status, 143);
    ASSERT_EQ(run_program({"experiment", folder / "s.toml", "-o", folder / "parts"}).status, 0);
    EXPECT_EQ(without_times(folder / "parts/results.csv"), without_times(folder / "whole/results.csv"));
}

}  // namespace
}  // namespace exitance::test

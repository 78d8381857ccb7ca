#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

const std::string points = "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n2,1.5,1,0,0,1\n";

/// All tests in this file share one solution.
class ProgramProbe : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        const Finished run =
            run_program({"solve", write_small_room(*folder_), "-o", *folder_ / "room.h5", "--error", "0.1", "-q"});
        ASSERT_EQ(run.status, 0) << run.err;
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    static std::string solution() { return *folder_ / "room.h5"; }
    static std::string file(const std::string& name) { return *folder_ / name; }

    static inline TemporaryFolder* folder_ = nullptr;
};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

}  // namespace

TEST_F(ProgramProbe, ReadsStandardInputAndWritesStandardOutput) {
    const Finished run = run_program({"probe", solution(), "--points", "-", "-o", "-"}, points);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    const std::vector<std::string> lines = lines_of(run.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "x,y,z,nx,ny,nz,E_r,E_g,E_b,B_r,B_g,B_b,se_r,se_g,se_b");
    EXPECT_NE(lines[2].find(",,,"), std::string::npos) << "a point in free space has no radiosity: " << lines[2];
}

TEST_F(ProgramProbe, FilesEqualStandardOutput) {
    write_text(file("points.csv"), points);
    const Finished shown = run_program({"probe", solution(), "--points", file("points.csv")});
    const Finished run = run_program({"probe", solution(), "--points", file("points.csv"), "-o", file("light.csv")});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(read_text(file("light.csv")), shown.out);
}

TEST_F(ProgramProbe, DirectAndIndirectLightMakeTheTotal) {
    std::vector<double> red;
    for (const std::string component : {"direct", "indirect", "total"}) {
        const Finished run = run_program({"probe", solution(), "--points", "-", "--component", component}, points);
        ASSERT_EQ(run.status, 0) << run.err;
        std::istringstream row(lines_of(run.out).at(1));
        std::string field;
        for (int i = 0; i < 7; ++i) std::getline(row, field, ',');
        red.push_back(std::stod(field));
    }
    EXPECT_GT(red[0], 0);
    EXPECT_GT(red[1], 0);
    EXPECT_NEAR(red[0] + red[1], red[2], 1e-8 * red[2]);  // ten digits are printed
}

TEST_F(ProgramProbe, PathsAgreeWithTheSolutionAndHaveStandardErrors) {
    const Finished run = run_program({"probe", solution(), "--points", "-", "--reference", "4096"}, points);
    ASSERT_EQ(run.status, 0) << run.err;
    const std::vector<std::string> lines = lines_of(run.out);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0], "x,y,z,nx,ny,nz,E_r,E_g,E_b,B_r,B_g,B_b,se_r,se_g,se_b");
    const auto field = [](const std::string& line, int wanted) {
        std::istringstream row(line);
        std::string word;
        for (int i = 0; i <= wanted; ++i) std::getline(row, word, ',');
        return std::stod(word);
    };
    const std::string own = lines_of(run_program({"probe", solution(), "--points", "-"}, points).out).at(1);
    EXPECT_GT(field(lines[1], 12), 0);
    // The solution has a requested error of 10%, to which the error of the paths is added.
    EXPECT_NEAR(field(lines[1], 6) / field(own, 6), 1, 0.15);
}

TEST_F(ProgramProbe, ReportsTheNumberOfPointsBetweenTwoSides) {
    // The small room with a sheet of two faces at x = 2, y < 1 on its floor.
    const std::string scene = write_small_room(*folder_, "parted");
    std::ofstream(scene, std::ios::app) << "v 2 0 0\nv 2 1 0\nv 2 1 2\nv 2 0 2\nusemtl grey\ng sheet\n"
                                           "f 13 14 15 16\nf 16 15 14 13\n";
    ASSERT_EQ(run_program({"solve", scene, "-o", file("parted.h5"), "--error", "0.2", "-q"}).status, 0);
    const std::string header = "x,y,z,nx,ny,nz\n", on_walls = "0,2,0,0,0,1\n4,3,0,0,0,1\n",
                      on_sheet = "2,0.5,0,0,0,1\n";
    for (const std::vector<std::string>& way : {std::vector<std::string>{}, {"--interpolant"}, {"--reference", "16"}}) {
        std::vector<std::string> words{"probe", file("parted.h5"), "--points", "-"};
        words.insert(words.end(), way.begin(), way.end());
        EXPECT_EQ(run_program(words, header + on_walls).err.find("warning"), std::string::npos);
        const Finished run = run_program(words, header + on_walls + on_sheet);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.err.find("warning: 1 of 3 points lie on a border"), std::string::npos) << run.err;
        EXPECT_EQ(lines_of(run.out).at(3).find("2,0.5,0,0,0,1,"), 0u) << "points are written as they were read";
    }
}

TEST_F(ProgramProbe, PartsOfTheSolutionAreUsageErrorsWithReferences) {
    const std::vector<std::vector<std::string>> pairs{{"--reference", "4", "--component", "direct"},
                                                      {"--reference", "4", "--interpolant"},
                                                      {"--interpolant", "--component", "indirect"},
                                                      {"--seed", "2"}};
    for (const std::vector<std::string>& pair : pairs) {
        std::vector<std::string> words{"probe", solution(), "--points", "-"};
        words.insert(words.end(), pair.begin(), pair.end());
        const Finished run = run_program(words, points);
        EXPECT_EQ(run.status, 2) << pair.front();
        EXPECT_EQ(run.out, "");
    }
}

TEST_F(ProgramProbe, ABadPointIsBadInputWithItsLine) {
    const Finished run =
        run_program({"probe", solution(), "--points", "-"}, "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n1,oops,0,0,0,1\n");
    EXPECT_EQ(run.status, 3);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(":3: "), std::string::npos) << run.err;
}

TEST_F(ProgramProbe, AnUnwritableFolderLeavesNoResult) {
    EXPECT_EQ(run_program({"probe", solution(), "--points", "-", "-o", file("absent/light.csv")}, points).status, 5);
}

TEST_F(ProgramProbe, OtherFilesAreBadInput) {
    write_text(file("not.h5"), "This is no HDF5 file.\n");
    for (const std::string name : {"not.h5", "absent.h5"}) {
        const Finished run = run_program({"probe", file(name), "--points", "-"}, points);
        EXPECT_EQ(run.status, 3) << name;
        EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
        EXPECT_EQ(run_program({"stats", file(name)}).status, 3);
    }
}

TEST_F(ProgramProbe, LeavesNoFileAfterASignal) {
    const TemporaryFolder folder;
    RunningProgram run({"probe", solution(), "--points", "-", "-o", folder / "E.csv", "--reference", "1000000000",
                        "--progress", "json"},
                       points);
    ASSERT_TRUE(run.wait_for("paths"));
    run.send(SIGTERM);
    EXPECT_EQ(run.finish().status, 143);
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

}  // namespace exitance::test

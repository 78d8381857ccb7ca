#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
}

}  // namespace

TEST(ProgramViewFactors, ClearGlassChangesNothing) {
    const TemporaryFolder folder;
    write_text(folder / "two.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nd 0.2\n");
    const std::string squares =
        "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "usemtl grey\nf 1 2 3 4\nf 8 7 6 5\n";
    write_text(folder / "open.obj", squares);
    write_text(folder / "glazed.obj", squares +
                                          "v -1 -1 0.5\nv 2 -1 0.5\nv 2 2 0.5\nv -1 2 0.5\n"
                                          "usemtl glass\nf 9 10 11 12\n");
    for (const std::string error : {"1e-1", "1e-2"}) {
        const auto table_of = [&](const std::string& scene) {
            const Finished run = run_program(
                {"viewfactors", folder / (scene + ".obj"), "--sky", "--error", error, "-o", folder / "F.csv"});
            EXPECT_EQ(run.status, 0) << run.err;
            return read_text(folder / "F.csv");
        };
        EXPECT_EQ(table_of("glazed"), table_of("open")) << error;
    }
}

TEST(ProgramViewFactors, TheTableHasARowAFaceAndClosedRoomsSumToOne) {
    const TemporaryFolder folder;
    const Finished run = run_program({"viewfactors", write_small_room(folder), "-o", folder / "room.csv"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::istringstream table(read_text(folder / "room.csv"));
    std::string line;
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(line, "surface,area,row_sum,F_1,F_2,F_3,F_4,F_5,F_6,F_7");
    std::size_t rows = 0;
    for (; std::getline(table, line); ++rows) {
        const std::vector<std::string> fields = fields_of(line);
        ASSERT_EQ(fields.size(), 10u);
        const double row_sum = std::stod(fields[2]);
        EXPECT_LE(row_sum, 1.0001);
        // From the floor and the lamp's front, the lamp's black back is not visible, so their rows sum to 1.
        if (rows == 0 || rows == 6) {
            EXPECT_NEAR(row_sum, 1, 1e-4);
        }
    }
    EXPECT_EQ(rows, 7u);
}

TEST(ProgramViewFactors, LengthUnitAndUprightAxisGiveTheTableInMetres) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"viewfactors", write_small_room(folder), "-o", folder / "m.csv"}).status, 0);
    const std::string scene = write_small_room_in(folder, 1000, true, "mm");
    const Finished run =
        run_program({"viewfactors", scene, "--length-unit", "mm", "--up", "y", "-o", folder / "mm.csv"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::istringstream expected(read_text(folder / "m.csv")), found(read_text(folder / "mm.csv"));
    std::string a, b;
    while (std::getline(expected, a)) {
        ASSERT_TRUE(std::getline(found, b));
        const std::vector<std::string> x = fields_of(a), y = fields_of(b);
        ASSERT_EQ(x.size(), y.size());
        if (x[0] == "surface") continue;
        for (std::size_t i = 1; i < x.size(); ++i) EXPECT_NEAR(std::stod(x[i]), std::stod(y[i]), 2e-4) << a;
    }
}

TEST(ProgramViewFactors, ToleranceOutOfRangeIsAUsageErrorAndAnUnwritableFolderLeavesNoResult) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    EXPECT_EQ(run_program({"viewfactors", scene, "-o", folder / "f.csv", "--tolerance", "2"}).status, 2);
    EXPECT_EQ(run_program({"viewfactors", scene, "-o", folder / "absent/f.csv"}).status, 5);
    EXPECT_EQ(run_program({"viewfactors", write_broken_scene(folder), "-o", folder / "f.csv"}).status, 3);
}

TEST(ProgramViewFactors, RowErrorsAndTheirCheckAreReported) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const Finished words = run_program({"viewfactors", scene, "-o", folder / "a.h5", "--error", "3e-3"});
    ASSERT_EQ(words.status, 0) << words.err;
    EXPECT_NE(words.out.find("error of rows at most"), std::string::npos) << words.out;
    EXPECT_NE(words.out.find("4 random rows"), std::string::npos) << words.out;
    const Finished json = run_program({"viewfactors", scene, "-o", folder / "b.h5", "--error", "3e-3", "--json"});
    ASSERT_EQ(json.status, 0) << json.err;
    const nlohmann::json facts = nlohmann::json::parse(json.out);
    EXPECT_LE(facts["row_error"], 3e-3);
    EXPECT_LE(facts["row_error_checked"], 6e-3);  // the noise of the rays is within R
    EXPECT_GT(facts["entries"], 20);
    EXPECT_EQ(facts["dropped"], 0);
    // The defect of the first pass does not depend on the requested error: a pair whose noise closure removes gets only
    // 4 x 4 rays. Here that is the ceiling with the floor: 0.30 without the lamp, of which 0.86 is visible. Its
    // standard deviation is 0.30 sqrt(0.86 x 0.14 / 16) = 0.026 at most, and 3.5 of these are 0.09.
    EXPECT_LE(facts["closure_defect"], 0.09);
    // After the closure, the floor and the lamp's front see nothing but fronts of faces: their rows sum to 1.
    EXPECT_NEAR(facts["row_sum"]["most"].get<double>(), 1, 3e-3);
    EXPECT_TRUE(facts["reciprocity_defect"].is_number());
    EXPECT_EQ(read_text(folder / "a.h5"), read_text(folder / "b.h5"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.h5.rows"));
    EXPECT_EQ(
        run_program({"viewfactors", scene, "-o", folder / "c.h5", "--error", "1e-3", "--tolerance", "1e-3"}).status, 2);
}

TEST(ProgramViewFactors, ChecksByRaysAreInTheSummaryAndInJson) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    const Finished words =
        run_program({"viewfactors", scene, "-o", folder / "a.mtx", "--tolerance", "1e-4", "--check", "20"});
    ASSERT_EQ(words.status, 0) << words.err;
    EXPECT_NE(words.out.find("20 random entries, 0 off by more than"), std::string::npos) << words.out;
    const Finished json =
        run_program({"viewfactors", scene, "-o", folder / "b.mtx", "--tolerance", "1e-4", "--check", "20", "--json"});
    ASSERT_EQ(json.status, 0) << json.err;
    const nlohmann::json facts = nlohmann::json::parse(json.out);
    EXPECT_EQ(facts["check"]["entries"], 20);
    EXPECT_LT(facts["check"]["largest_deviation_in_standard_errors"], 5);  // the largest of 20 random entries
    EXPECT_LE(facts["entry_reciprocity_defect"], 1e-4);
    EXPECT_EQ(facts["pairs_unsettled"], 0);
    EXPECT_EQ(read_text(folder / "a.mtx"), read_text(folder / "b.mtx"));
    const Finished none = run_program({"viewfactors", scene, "-o", folder / "c.h5", "--check", "0"});
    EXPECT_EQ(none.status, 0) << none.err;
    EXPECT_EQ(none.out.find("by lot"), std::string::npos);
}

/// Writes blocks on a floor, which take some seconds at a small tolerance.
std::string write_long_work(const TemporaryFolder& folder) {
    std::string text = "v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n";
    for (int k = 0, v = 5; k < 100; ++k, v += 8) {
        const double x = 4 * (k % 10) + 0.1 * (k % 3), y = 4 * (k / 10) + 0.1 * (k % 7), h = 1 + 0.37 * (k % 11);
        for (double z : {0.0, h})
            for (auto [u, w] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}})
                text += "v " + std::to_string(x + u) + " " + std::to_string(y + w) + " " + std::to_string(z) + "\n";
        const auto face = [&](int a, int b, int c, int d) {
            for (int corner : {a, b, c, d}) text += (corner == a ? "f " : " ") + std::to_string(v + corner);
            text += "\n";
        };
        face(4, 5, 6, 7), face(0, 1, 5, 4), face(1, 2, 6, 5), face(2, 3, 7, 6), face(3, 0, 4, 7);
    }
    write_text(folder / "blocks.obj", text);
    return folder / "blocks.obj";
}

std::size_t files_in(const TemporaryFolder& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / "")) ++count;
    return count;
}

TEST(ProgramViewFactors, ALimitBeforeTheFirstRowLeavesNoFile) {
    const TemporaryFolder folder;
    const std::string scene = write_long_work(folder);
    for (const char* demand : {"--error", "--tolerance"}) {
        const Finished run =
            run_program({"viewfactors", scene, "-o", folder / "f.csv", demand, "1e-6", "--time-limit", "1e-4"});
        EXPECT_EQ(run.status, 5) << run.out;
        EXPECT_NE(run.err.find("stopped"), std::string::npos) << run.err;
        EXPECT_EQ(files_in(folder), 1u);
    }
}

/// Sends a signal once the first rows are in the work file next to the output.
Finished interrupt_after_rows(const std::vector<std::string>& words, const std::string& rows, int signal) {
    RunningProgram program(words);
    std::error_code none;
    for (int k = 0; k < 60'000; ++k) {
        if (std::filesystem::exists(rows, none) && std::filesystem::file_size(rows, none) > 1000) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    program.send(signal);
    return program.finish();
}

TEST(ProgramViewFactors, ASignalKeepsFinishedRowsAndResumeGivesTheSameBytes) {
    const TemporaryFolder folder;
    const std::string scene = write_long_work(folder);
    const std::vector<std::string> work{"viewfactors", scene, "-o", folder / "f.h5", "--error", "1e-2", "--check", "0"};
    const Finished stopped = interrupt_after_rows(work, folder / "f.h5.rows", SIGTERM);
    EXPECT_EQ(stopped.status, 4);
    EXPECT_EQ(stopped.out.find("defect"), std::string::npos) << "was not computed: " << stopped.out;
    EXPECT_TRUE(std::filesystem::exists(folder / "f.h5"));
    std::vector<std::string> on = work;
    on.push_back("--resume");
    interrupt_after_rows(on, folder / "f.h5.rows", SIGKILL);
    EXPECT_EQ(run_program(on).status, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "f.h5.rows"));
    std::vector<std::string> whole = work;
    whole[3] = folder / "whole.h5";
    EXPECT_EQ(run_program(whole).status, 0);
    EXPECT_EQ(read_text(folder / "f.h5"), read_text(folder / "whole.h5"));
}

TEST(ProgramViewFactors, ResumeOfOtherWorkIsAnError) {
    const TemporaryFolder folder;
    const std::string scene = write_long_work(folder);
    const std::string output = folder / "f.h5";
    interrupt_after_rows({"viewfactors", scene, "-o", output, "--error", "1e-2", "--check", "0"}, output + ".rows",
                         SIGKILL);
    const Finished other = run_program({"viewfactors", scene, "-o", output, "--error", "2e-2", "--resume"});
    EXPECT_EQ(other.status, 3);
    EXPECT_NE(other.err.find("other options"), std::string::npos) << other.err;
}

TEST(ProgramViewFactors, ARunThatStartsAgainSaysSoAndKeepsTheRowsUntilItIsComplete) {
    const TemporaryFolder folder;
    const std::vector<std::string> work{
        "viewfactors", write_long_work(folder), "-o", folder / "f.h5", "--error", "1e-2", "--check", "0"};
    const std::string rows = folder / "f.h5.rows";
    interrupt_after_rows(work, rows, SIGKILL);
    std::vector<std::string> limited = work;
    limited.insert(limited.end(), {"--time-limit", "1e-4"});
    const Finished none = run_program(limited);
    EXPECT_EQ(none.status, 5);
    EXPECT_NE(none.err.find("f.h5.rows has "), std::string::npos) << none.err;
    EXPECT_NE(none.err.find("--resume"), std::string::npos) << none.err;
    EXPECT_TRUE(std::filesystem::exists(rows)) << "a run without a row leaves those of the earlier one";
    EXPECT_FALSE(std::filesystem::exists(rows + ".old"));
    EXPECT_EQ(run_program(work).status, 0);
    EXPECT_EQ(files_in(folder), 2u);  // the scene and the result
}

TEST(ProgramViewFactors, SaysWhichErrorsItsCheckFinds) {
    const TemporaryFolder folder;
    const Finished run = run_program(
        {"viewfactors", write_small_room(folder), "-o", folder / "f.csv", "--error", "1e-2", "--check-rays", "100000"});
    EXPECT_EQ(run.status, 0) << run.err;
    const std::string words = "where these rays find any error above ";
    const std::size_t at = run.out.find(words);
    ASSERT_NE(at, std::string::npos) << run.out;
    const double found = std::stod(run.out.substr(at + words.size()));
    EXPECT_GT(found, 1e-2);
    EXPECT_LT(found, 2e-2);  // ten times the default number of rays
}

TEST(ProgramViewFactors, ReadsALevelOfDetailOfCityJson) {
    const TemporaryFolder folder;
    write_text(folder / "c.city.json", R"({"type":"CityJSON","version":"2.0",
"transform":{"scale":[1,1,1],"translate":[0,0,0]},"vertices":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]],
"CityObjects":{"b":{"type":"Building","geometry":[
{"type":"MultiSurface","lod":"1.2","boundaries":[[[0,1,2,3]]]},
{"type":"MultiSurface","lod":"2.0","boundaries":[[[0,1,2]],[[0,2,3]]]}]}}})");
    const auto surfaces = [&](const std::vector<std::string>& options) {
        std::vector<std::string> words{"viewfactors", folder / "c.city.json", "-o", folder / "f.csv", "--check", "0"};
        words.insert(words.end(), options.begin(), options.end());
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.out.substr(0, run.out.find(' '));
    };
    EXPECT_EQ(surfaces({}), "2");
    EXPECT_EQ(surfaces({"--lod", "1.2"}), "1");
    EXPECT_EQ(surfaces({"--lod", "2"}), "2");
    EXPECT_EQ(run_program({"check", folder / "c.city.json", "--lod", "x"}).status, 2);
    const Finished other = run_program({"check", write_small_room(folder), "--lod", "2"});
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find("none of the files is CityJSON"), std::string::npos) << other.err;
}

TEST(ProgramViewFactors, ReadsView3dAndStl) {
    const TemporaryFolder folder;
    write_text(
        folder / "two.vs3",
        "T two squares\nF 3\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0\nV 4 0 1 0\nV 5 0 0 1\nV 6 1 0 1\nV 7 1 1 1\nV 8 0 1 1\n"
        "S 1 1 2 3 4 0 0 0.9 low\nS 2 8 7 6 0 0 0 0.8 high\nS 3 8 6 5 0 0 2 0.8 high2\nE\n");
    const Finished run = run_program({"viewfactors", folder / "two.vs3", "-o", folder / "f.csv", "--check", "0"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::istringstream table(read_text(folder / "f.csv"));
    std::string line;
    std::getline(table, line), std::getline(table, line);
    const std::vector<std::string> fields = fields_of(line);
    ASSERT_EQ(fields.size(), 5u);                                // two rows: the triangles belong to one surface
    EXPECT_NEAR(std::stod(fields[4]), 0.199824895698387, 1e-4);  // unit squares at distance 1
    write_text(folder / "one.stl",
               "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
               "endloop\nendfacet\nendsolid s\n");
    EXPECT_EQ(run_program({"viewfactors", folder / "one.stl", "-o", folder / "g.csv"}).status, 0);
}

}  // namespace exitance::test

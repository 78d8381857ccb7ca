#include <gtest/gtest.h>

#include "exitance/io/solution/solution_file.hpp"
#include "run_program.hpp"
#include "support/sample_solution.hpp"

namespace exitance::test {
namespace {

const std::vector<std::string> verbs{"solve",  "probe", "compare",  "stats",
                                     "export", "check", "generate", "viewfactors"};

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

}  // namespace

TEST(ProgramUsage, HelpBeginsWithAnExampleThatNamesTheVerb) {
    for (const std::string& verb : verbs) {
        const Finished help = run_program({verb, "--help"});
        EXPECT_EQ(help.status, 0) << verb;
        EXPECT_EQ(help.out.find("Example:\n  exitance " + verb), 0u) << help.out;
        EXPECT_EQ(help.err, "");
        EXPECT_EQ(run_program({"help", verb}).out, help.out);
    }
}

TEST(ProgramUsage, HelpListsEveryVerb) {
    const Finished help = run_program({"--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(first_line(help.out), "Example:");
    for (const std::string& verb : verbs) EXPECT_NE(help.out.find("\n  " + verb + " "), std::string::npos) << verb;
}

TEST(ProgramUsage, OptionsOfGrowingCellsAreErrorsWithOtherMethods) {
    for (const auto& [option, value] : {std::pair{"--gcs", "classic"}, {"--max-units", "64"}}) {
        const Finished run = run_program({"solve", "room.obj", "--method", "matrix", option, value, "-o", "s.h5"});
        EXPECT_EQ(run.status, 2) << option;
        EXPECT_NE(run.err.find("growing-cells"), std::string::npos) << run.err;
    }
}

TEST(ProgramUsage, UnsupportedOptionsNameTheMethodsThatSupportThem) {
    const Finished run = run_program({"solve", "room.obj", "--method", "hierarchical", "--overshooting", "-o", "s.h5"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("--overshooting"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("progressive, substructuring"), std::string::npos) << run.err;
}

TEST(ProgramUsage, SolvingIntoAMeshOrAPictureNamesTheVerbThatMakesIt) {
    for (const auto& [name, verb] : {std::pair{"s.vtu", "export"}, {"s.glb", "export"}, {"s.png", "render"}}) {
        const Finished run = run_program({"solve", "room.obj", "-o", name});
        EXPECT_EQ(run.status, 2) << name;
        EXPECT_NE(run.err.find(std::string("`") + verb + "`"), std::string::npos) << run.err;
    }
}

TEST(ProgramUsage, VersionNamesTheLibraries) {
    const Finished version = run_program({"--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_EQ(version.out.find("exitance "), 0u);
    for (const char* library : {"Embree ", "oneTBB 2", "CGAL ", "HDF5 1."})
        EXPECT_NE(version.out.find(library), std::string::npos) << version.out;
}

TEST(ProgramUsage, AnUnknownVerbIsAUsageErrorThatNamesTheNearest) {
    const Finished run = run_program({"sovle", "room.obj"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err, "error: there is no verb 'sovle'\nhint: did you mean 'solve'?\n");
    EXPECT_EQ(run_program({}).status, 2);
    EXPECT_NE(run_program({"frobnicate"}).err.find("the verbs are solve, "), std::string::npos);
}

TEST(ProgramUsage, AnUnknownOptionIsAUsageErrorThatNamesTheNearest) {
    const Finished run = run_program({"solve", "room.obj", "--eror", "0.1", "-o", "s.h5"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err, "error: '--eror' is not a known option or argument\nhint: did you mean --error?\n");
}

TEST(ProgramUsage, VerbsWithParallelLoopsTakeANumberOfThreadsAndOthersSayWhyNot) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    EXPECT_EQ(run_program({"stats", folder / "s.h5", "--threads", "2"}).status, 0);
    EXPECT_EQ(run_program({"export", folder / "s.h5", "-o", folder / "s.obj", "--threads", "2"}).status, 0);
    const Finished run = run_program({"generate", "list", "--threads", "2"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("--threads: this verb uses one thread only"), std::string::npos) << run.err;
}

TEST(ProgramUsage, AFileOfPointsWithoutItsOptionIsNamedWithIt) {
    const Finished run = run_program({"probe", "s.h5", "points.csv"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("--points points.csv"), std::string::npos) << run.err;
}

TEST(ProgramUsage, ASolutionInPlaceOfASceneIsNamedAsSuch) {
    const TemporaryFolder folder;
    for (const char* name : {"a.h5", "b.h5"}) write_text(folder / name, "");
    const Finished solve = run_program({"solve", folder / "a.h5", "-o", folder / "s.h5"});
    EXPECT_EQ(solve.status, 3);
    EXPECT_NE(solve.err.find("is a solution or other HDF5 file"), std::string::npos) << solve.err;
    EXPECT_NE(solve.err.find("render"), std::string::npos) << solve.err;
}

TEST(ProgramUsage, ValuesOutOfRangeAreUsageErrorsThatNameTheOptionAndTheValue) {
    const std::vector<std::vector<std::string>> cases{
        {"--error", "-1"},        {"--error", "nan"},    {"--error", "0"},          {"--error", "two"},
        {"--mesh-size", "0"},     {"--bounces", "1.5"},  {"--bounces", "-1"},       {"--method", "matrx"},
        {"--basis", "cubic"},     {"--threads", "0"},    {"--max-iterations", "0"}, {"--time-limit", "0"},
        {"--memory-limit", "4X"}, {"--seed", "-3"},      {"--visibility", "yes"},   {"--relaxation", "sors"},
        {"--progress", "loudly"}, {"--min-area", "inf"}, {"--residual", "1e-3x"},   {"--memory-limit", "0"},
    };
    for (const std::vector<std::string>& option : cases) {
        const Finished run = run_program({"solve", "room.obj", "-o", "s.h5", option[0], option[1]});
        EXPECT_EQ(run.status, 2) << option[0] << " " << option[1];
        EXPECT_EQ(run.err.find("error: " + option[0] + ": "), 0u) << run.err;
        EXPECT_NE(first_line(run.err).find(option[1].substr(0, 3)), std::string::npos) << run.err;
        EXPECT_NE(run.err.find("\nhint: "), std::string::npos) << run.err;
        EXPECT_EQ(run.out, "");
    }
}

TEST(ProgramUsage, AMissingValueOrInputIsAUsageError) {
    EXPECT_EQ(first_line(run_program({"solve", "room.obj", "--error"}).err), "error: --error: its value is missing");
    EXPECT_EQ(run_program({"solve", "room.obj", "--error"}).status, 2);
    EXPECT_EQ(first_line(run_program({"solve", "room.obj", "--error", "1", "--error", "2"}).err),
              "error: --error: is given more than once");
    EXPECT_EQ(run_program({"solve"}).status, 2);
    for (const auto& [words, where] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"solve", "room.obj", "--sky", "", "-o", "s.h5"}, "--sky"},
             {{"solve", "room.obj", "-o", ""}, "--output"},
             {{"solve", "", "-o", "s.h5"}, "SCENE"},
             {{"probe", "s.h5", "--points="}, "--points"}}) {
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 2) << where;
        EXPECT_NE(first_line(run.err).find(where + ": its value is"), std::string::npos) << run.err;
    }
    EXPECT_EQ(run_program({"export", "room.h5"}).status, 2);
    EXPECT_EQ(run_program({"stats", "a.h5", "b.h5"}).status, 2);
}

TEST(ProgramUsage, OptionsOfDiscontinuityMeshingElsewhereAreNamed) {
    const std::vector<std::vector<std::string>> wrong{
        {"--triangulation", "shortest", "--method", "matrix"},
        {"--dm-sources", "3", "--method", "discontinuity", "--bounces", "0"},
        {"--premesh", "coarse", "--method", "discontinuity"},
        {"--dm-quality", "delaunay", "--method", "matrix"},
        {"--dm-structure", "bsp", "--method", "matrix"},
        {"--dm-structure", "octree", "--method", "discontinuity"},
        {"--dm-quality", "delaunay", "--triangulation", "shortest", "--method", "discontinuity"},
        {"--dm-element", "clough-tocher", "--method", "matrix"},
        {"--dm-element", "cubic", "--method", "discontinuity"},
        {"--dm-element", "clough-tocher", "--method", "discontinuity", "--local-pass", "c"},
        {"--layers", "on", "--method", "hierarchical"},
        {"--layers", "both", "--method", "discontinuity"},
        {"--layers", "on", "--method", "discontinuity", "--dm-element", "clough-tocher"},
        {"--layers", "on", "--method", "discontinuity", "--local-pass", "a"},
        {"--dm-sources", "much", "--method", "discontinuity"},
        {"--dm-sources", "-1W", "--method", "discontinuity"},
    };
    const TemporaryFolder folder;
    for (const auto& words : wrong) {
        std::vector<std::string> all{"solve", "no_such_scene.obj", "-o", folder / "s.h5"};
        all.insert(all.end(), words.begin(), words.end());
        const Finished run = run_program(all);
        EXPECT_EQ(run.status, 2) << words[0];
        EXPECT_NE(run.err.find(words[0]), std::string::npos) << run.err;
    }
}

}  // namespace exitance::test

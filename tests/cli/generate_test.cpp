#include <gtest/gtest.h>

#include "cli/small_scene.hpp"

namespace exitance::test {

TEST(ProgramGenerate, WritesASceneThatChecksWithoutFindings) {
    const TemporaryFolder folder;
    const std::string scene = folder / "complex.obj";
    const Finished run = run_program({"generate", "complex", "m=2", "-o", scene});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(folder.count(), 2u) << "the scene and its materials";
    const Finished check = run_program({"check", scene});
    EXPECT_EQ(check.status, 0);
    // Furniture made of single sheets has open edges, which are reported but not counted as findings.
    EXPECT_NE(check.out.find("The scene can be used: 59 surfaces"), std::string::npos) << check.out;
    for (const char* finding : {"error:", "warning:", "repair:"})
        EXPECT_EQ(check.out.find(finding), std::string::npos) << check.out;
}

TEST(ProgramGenerate, ListNamesTheFamiliesAndTheirParameters) {
    const Finished run = run_program({"generate", "list"});
    EXPECT_EQ(run.status, 0);
    for (const char* family : {"cornell", "office", "complex", "tube", "nx="})
        EXPECT_NE(run.out.find(family), std::string::npos) << family;
}

TEST(ProgramGenerate, WrongFamiliesAndParametersAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string scene = folder / "x.obj";
    for (const std::vector<std::string>& words : {std::vector<std::string>{"castle"},
                                                  {"complex", "q=3"},
                                                  {"complex", "m=many"},
                                                  {"complex", "m"},
                                                  {"complex", "m=1", "m=2"}}) {
        std::vector<std::string> arguments{"generate"};
        arguments.insert(arguments.end(), words.begin(), words.end());
        arguments.insert(arguments.end(), {"-o", scene});
        const Finished run = run_program(arguments);
        EXPECT_EQ(run.status, 2) << words.back();
        EXPECT_EQ(run.err.find("error: "), 0u);
    }
    EXPECT_EQ(run_program({"generate", "complex"}).status, 2);
    EXPECT_EQ(folder.count(), 0u);
}

TEST(ProgramGenerate, AnUnwritableFolderLeavesNoResult) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_program({"generate", "cornell", "-o", folder / "absent/x.obj"}).status, 5);
}

}  // namespace exitance::test

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "run_program.hpp"
#include "support/temporary_folder.hpp"

namespace exitance::test {
namespace {

std::string content_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A solved box with a lamp, a point in it, and view factors.
class ProgramNamedFiles : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder = new TemporaryFolder;
        ASSERT_EQ(run_program({"generate", "tube", "length=2", "-o", path("scene.obj"), "-q"}).status, 0);
        ASSERT_EQ(run_program({"solve", path("scene.obj"), "-o", path("s.h5"), "--error", "0.2", "-q"}).status, 0);
        ASSERT_EQ(run_program({"viewfactors", path("scene.obj"), "-o", path("f.h5"), "-q"}).status, 0);
        std::ofstream(path("p.csv")) << "x,y,z,nx,ny,nz\n0.5,0.5,0.5,0,0,1\n";
        std::ofstream(path("t.csv")) << "surface,emissivity,temperature\n0,0.9,300\n";
    }
    static void TearDownTestSuite() { delete folder; }
    static std::string path(const std::string& name) { return *folder / name; }
    static TemporaryFolder* folder;
};
TemporaryFolder* ProgramNamedFiles::folder = nullptr;

}  // namespace

TEST_F(ProgramNamedFiles, InputsAreNotReplacedByOutputs) {
    std::error_code failed;
    std::filesystem::create_symlink(path("s.h5"), path("link.csv"), failed);
    ASSERT_FALSE(failed);
    const struct {
        std::vector<std::string> words;
        std::string input;
    } runs[] = {
        {{"probe", path("s.h5"), "--points", path("p.csv"), "-o", path("p.csv")}, "p.csv"},
        {{"probe", path("s.h5"), "--points", path("p.csv"), "-o", path("s.h5")}, "s.h5"},
        {{"probe", path("s.h5"), "--points", path("p.csv"), "-o", path("./s.h5")}, "s.h5"},
        {{"probe", path("s.h5"), "--points", path("p.csv"), "-o", path("link.csv")}, "s.h5"},
        {{"solve", path("scene.obj"), "--importance", path("p.csv"), "-o", path("p.csv")}, "p.csv"},
        {{"solve", path("scene.obj"), "-o", path("scene.obj")}, "scene.obj"},
        {{"solve", path("scene.obj"), "-o", path("scene.mtl")}, "scene.mtl"},
        {{"export", path("s.h5"), "-o", path("scene.obj")}, "scene.obj"},
        {{"bake", path("s.h5"), "--uv", "unwrap", "-o", path("")}, "scene.obj"},
        {{"viewfactors", path("scene.obj"), "-o", path("scene.obj")}, "scene.obj"},
        {{"heat", path("f.h5"), "--table", path("t.csv"), "-o", path("t.csv")}, "t.csv"},
        {{"heat", path("f.h5"), "--table", path("t.csv"), "-o", path("q.csv"), "--gebhart", path("f.h5")}, "f.h5"},
    };
    for (const auto& [words, input] : runs) {
        const std::string before = content_of(path(input));
        ASSERT_FALSE(before.empty()) << input;
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 2) << words[0] << ' ' << input << ": " << run.err;
        EXPECT_TRUE(content_of(path(input)) == before) << words[0] << ' ' << input;
    }
}

TEST_F(ProgramNamedFiles, TwoOutputsHaveDifferentNames) {
    const Finished run = run_program({"heat", path("f.h5"), "--table", path("t.csv"), "-o", path("q.csv"), "--exchange",
                                      path("x.csv"), "--gebhart", path("./x.csv")});
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_NE(run.err.find("is also the output of --"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(path("x.csv")));
    EXPECT_EQ(run_program({"experiment", "no_such_study", "-o", "no_such_study"}).err.find("is also"),
              std::string::npos)
        << "the name of a study is no file";
}

TEST_F(ProgramNamedFiles, DevicesAndStandardStreamsMayBeNamedTwice) {
    EXPECT_EQ(run_program({"probe", path("s.h5"), "--points", path("p.csv"), "-o", "/dev/null"}).status, 0);
    const Finished run = run_program({"solve", path("scene.obj"), "-o", "-"});
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_NE(run.err.find("solutions are not written to standard output"), std::string::npos) << run.err;
}

TEST_F(ProgramNamedFiles, AModelBesideTheSceneIsBakedIntoItsFolder) {
    EXPECT_EQ(run_program({"bake", path("s.h5"), "-o", path(""), "--density", "2", "-q"}).status, 0)
        << "without --uv unwrap, scene.obj is not written";
}

}  // namespace exitance::test

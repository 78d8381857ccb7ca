#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace exitance::test {
namespace {

/// A box with two lamps, one of which has two faces; the walls reflect no green.
constexpr const char* two_lamps =
    "mtllib s.mtl\n"
    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
    "v .2 .2 1.9\nv .6 .2 1.9\nv .6 .6 1.9\nv .2 .6 1.9\nv 1.4 1.4 1.9\nv 1.8 1.4 1.9\nv 1.8 1.8 1.9\nv 1.4 1.8 1.9\n"
    "usemtl wall\ng room\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
    "usemtl lamp\ng left\nf 9 12 11 10\ng right\nf 13 16 15 14\n";
constexpr const char* materials = "newmtl wall\nKd .6 0 .4\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n";

class ProgramMix : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder = new TemporaryFolder;
        std::ofstream(*folder / "s.obj") << two_lamps;
        std::ofstream(*folder / "s.mtl") << materials;
        const Finished run =
            run_program({"solve", *folder / "s.obj", "--light-groups", "--error", "0.05", "-o", *folder / "s.h5"});
        ASSERT_EQ(run.status, 0) << run.err;
    }
    static void TearDownTestSuite() { delete folder; }
    static std::string path(const std::string& name) { return *folder / name; }
    /// Irradiance at the centre of the floor, three bands.
    static std::vector<double> light(const std::string& name) {
        std::ofstream(path("p.csv")) << "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n";
        const Finished run = run_program({"probe", path(name), "--points", path("p.csv"), "-o", "-", "-q"});
        std::istringstream fields(run.out.substr(run.out.find('\n') + 1));
        std::vector<double> numbers;
        for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
        return numbers.size() < 9 ? std::vector<double>(3) : std::vector<double>(&numbers[6], &numbers[9]);
    }
    static TemporaryFolder* folder;
};
TemporaryFolder* ProgramMix::folder = nullptr;

}  // namespace

TEST_F(ProgramMix, DimsLayersWithTheirLamps) {
    const std::vector<std::string> solve{"solve",    path("s.obj"), "--method", "discontinuity",
                                         "--layers", "on",          "--error",  "0.05"};
    const auto solved = [&](std::vector<std::string> more) {
        more.insert(more.begin(), solve.begin(), solve.end());
        return run_program(more);
    };
    Finished run = solved({"--light-groups", "-o", path("layers.h5")});
    ASSERT_EQ(run.status, 0) << run.err;
    run = run_program({"mix", path("layers.h5"), "left=0", "right=2", "-o", path("mixed.h5")});
    ASSERT_EQ(run.status, 0) << run.err;
    // Both lamps are placed symmetrically, so twice one lamp equals both.
    EXPECT_NEAR(light("mixed.h5")[0], light("layers.h5")[0], 0.05 * light("layers.h5")[0]);
    for (const std::string name : {"left", "right"}) {
        run = run_program({"render", path("mixed.h5"), "-o", path("layer.png"), "--layer", name, "--size", "20x20"});
        EXPECT_EQ(run.status, 0) << run.err;
    }
    EXPECT_EQ(run_program({"export", path("mixed.h5"), "-o", path("mixed.vtu")}).status, 0);
    // Without layers, a discontinuity mesh holds the light of all lamps together.
    run = run_program({"solve", path("s.obj"), "--method", "discontinuity", "--light-groups", "-o", path("no.h5")});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("--layers on"), std::string::npos) << run.err;
    // Snapshots after each source.
    run = solved({"--snapshots", "rounds", "-o", path("steps.h5")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run_program({"stats", path("steps.0001.h5")}).status, 0);
    EXPECT_EQ(run_program({"stats", path("steps.0002.h5")}).status, 0);
    EXPECT_NE(run_program({"stats", path("steps.0003.h5")}).status, 0);
}

TEST_F(ProgramMix, DimsLampsAndWritesACompleteSolution) {
    const Finished run = run_program({"mix", path("s.h5"), "left=0", "right=2", "-o", path("d.h5")});
    ASSERT_EQ(run.status, 0) << run.err;
    // Both lamps are placed symmetrically, so twice one lamp equals both.
    EXPECT_NEAR(light("d.h5")[0], light("s.h5")[0], 0.05 * light("s.h5")[0]);
    EXPECT_EQ(run_program({"stats", path("d.h5")}).status, 0);
    EXPECT_EQ(run_program({"render", path("d.h5"), "-o", path("d.png"), "--size", "40x30"}).status, 0);
    const Finished back = run_program({"mix", path("d.h5"), "left=1", "right=1", "-o", path("b.h5")});
    ASSERT_EQ(back.status, 0) << back.err;
    EXPECT_NEAR(light("b.h5")[0], light("s.h5")[0], 1e-4 * light("s.h5")[0]);
}

TEST_F(ProgramMix, KnowsTheEnergyOfLightFromTheSky) {
    // The box without its ceiling, so that the sky shines in and light escapes.
    std::string open(two_lamps);
    open.erase(open.find("f 5 8 7 6\n"), 10);
    std::ofstream(path("o.obj")) << open;
    ASSERT_EQ(run_program({"solve", path("o.obj"), "--sky", "overcast,dhi=50", "--light-groups", "--error", "0.05",
                           "-o", path("o.h5")})
                  .status,
              0);
    const auto energy = [&](const std::string& name, const std::string& key) {
        const std::string json = run_program({"stats", path(name), "--json"}).out;
        return nlohmann::json::parse(json)["energy"][key].get<double>();
    };
    const Finished same = run_program({"mix", path("o.h5"), "left=1", "-o", path("o1.h5")});
    ASSERT_EQ(same.status, 0) << same.err;
    // The exported mesh has up to three times the requested error, and the sky's share is estimated to 1%.
    for (const char* const key : {"emitted", "absorbed", "escaped"})
        EXPECT_NEAR(energy("o1.h5", key), energy("o.h5", key), 0.05 * energy("o.h5", "emitted")) << key;
    ASSERT_EQ(run_program({"mix", path("o.h5"), "left=0", "right=0", "-o", path("o0.h5")}).status, 0);
    const double rest = energy("o0.h5", "emitted");
    EXPECT_GT(rest, 0);
    EXPECT_LT(rest, energy("o.h5", "emitted"));
    EXPECT_NEAR(energy("o0.h5", "absorbed") + energy("o0.h5", "escaped"), rest, 0.05 * rest);
}

TEST_F(ProgramMix, RepaintsBandsThatHadNoReflectedLight) {
    const Finished run = run_program({"mix", path("s.h5"), "--reflectance", "wall=0.6,0.6,0.4", "-o", path("g.h5")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_GT(light("g.h5")[1], 1.2 * light("s.h5")[1]);
    EXPECT_NEAR(light("g.h5")[1], light("g.h5")[0], 0.05 * light("g.h5")[0]) << "red and green are alike now";
}

TEST_F(ProgramMix, ListsLightGroups) {
    const Finished wrong = run_program({"mix", path("s.h5"), "middle=1", "-o", path("x.h5")});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("there are left, right"), std::string::npos) << wrong.err;
    EXPECT_EQ(run_program({"mix", path("s.h5"), "left=1", "left=2", "-o", path("x.h5")}).status, 2);
    EXPECT_EQ(run_program({"mix", path("s.h5"), "left=1", "-o", path("s.mtl")}).status, 2) << "not a solution's name";
    EXPECT_EQ(run_program({"mix", path("s.h5"), "left=-1", "-o", path("x.h5")}).status, 2);
    EXPECT_EQ(run_program({"mix", path("s.h5"), "--reflectance", "wall=1,1,1", "-o", path("x.h5")}).status, 2);
    ASSERT_EQ(run_program({"solve", path("s.obj"), "--error", "0.2", "-o", path("n.h5")}).status, 0);
    const Finished none = run_program({"mix", path("n.h5"), "left=1", "-o", path("x.h5")});
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("--light-groups"), std::string::npos) << none.err;
    EXPECT_EQ(
        run_program({"solve", path("s.obj"), "--light-groups", "--method", "discontinuity", "-o", path("x.h5")}).status,
        2);
}

}  // namespace exitance::test

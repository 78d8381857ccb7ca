#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

TEST(ProgramProbes, WritesAGridOrPointsAsJsonAndHdf5) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", out = folder / "probes.json";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const std::string grid = "0.5,0.5,0.5 1,1,0.5 3,2,4";
    const Finished run = run_program({"probes", solution, "--grid", grid, "-o", out, "--rays", "256"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("24 probes, 0 of them"), std::string::npos) << run.err;
    const auto json = nlohmann::json::parse(read_text(out));
    EXPECT_EQ(json["version"], 1);
    EXPECT_EQ(json["unit"], "W/(m^2 sr)");
    EXPECT_EQ(json["grid"]["count"], (std::vector<int>{3, 2, 4}));
    ASSERT_EQ(json["probes"].size(), 24u);
    const auto& probe = json["probes"][1 + 3 * (1 + 2 * 2)];
    EXPECT_EQ(probe["position"], (std::vector<double>{1.5, 1.5, 1.5}));
    EXPECT_EQ(probe["radiance"].size(), 9u);
    EXPECT_EQ(probe["standard_error"].size(), 9u);
    EXPECT_EQ(probe["back_share"], 0);
    EXPECT_GT(probe["radiance"][0][0], 0);
    EXPECT_GT(probe["radiance"][2][0], 0);  // light comes from above

    write_text(folder / "points.csv", "name,x,y,z\na,1.5,1.5,1.5\n");
    write_text(folder / "points.pts", "# one point\n1.5 1.5 1.5 0 0 1\n");
    for (const std::string file : {"points.csv", "points.pts"}) {
        ASSERT_EQ(run_program({"probes", solution, "--points", folder / file, "-o", out, "--rays", "256"}).status, 0);
        // The directions of rays depend on the place alone.
        EXPECT_EQ(nlohmann::json::parse(read_text(out))["probes"][0]["radiance"], probe["radiance"]) << file;
    }
    ASSERT_EQ(run_program({"probes", solution, "--grid", grid, "-o", folder / "probes.h5"}).status, 0);
    EXPECT_GT(std::filesystem::file_size(folder / "probes.h5"), 1000u);
}

TEST(ProgramProbes, RejectsInvalidOptions) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", out = folder / "probes.json";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const std::string grid = "0,0,0 1,1,1 2,2,2";
    EXPECT_EQ(run_program({"probes", solution, "-o", out}).status, 2);
    EXPECT_EQ(run_program({"probes", solution, "--grid", grid, "--points", "p.csv", "-o", out}).status, 2);
    EXPECT_EQ(run_program({"probes", solution, "--grid", "0,0,0 1,1,1 2,2", "-o", out}).status, 2);
    EXPECT_EQ(run_program({"probes", solution, "--grid", "0,0,0 1,1,1 2,0,2", "-o", out}).status, 2);
    EXPECT_EQ(run_program({"probes", solution, "--grid", grid, "--rays", "100", "-o", out}).status, 2);
    EXPECT_EQ(run_program({"probes", solution, "--points", folder / "absent.csv", "-o", out}).status, 3);
    EXPECT_EQ(run_program({"probes", folder / "absent.h5", "--grid", grid, "-o", out}).status, 3);
    write_text(folder / "bad.pts", "1 2 three\n");
    const Finished bad = run_program({"probes", solution, "--points", folder / "bad.pts", "-o", out});
    EXPECT_EQ(bad.status, 3);
    EXPECT_NE(bad.err.find("three numbers"), std::string::npos) << bad.err;
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace exitance::test

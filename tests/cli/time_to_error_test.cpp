#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"
#include "support/places.hpp"

namespace exitance::test {

using OrderedJson = nlohmann::ordered_json;

TEST(TimeToError, MeasuresTheSameErrorAsCompare) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), fine = folder / "fine.h5", same = folder / "same.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", fine, "--error", "0.05", "-q"}).status, 0);
    ASSERT_EQ(run_program({"solve", scene, "-o", same, "--error", "0.1", "--threads", "1", "-q"}).status, 0);
    std::string points = "x,y,z,nx,ny,nz\n";
    for (const char* point : {"1,1,0,0,0,1", "3,2,0,0,0,1", "0,1,1,1,0,0", "4,2,2,-1,0,0", "2,0,1,0,1,0",
                              "1,3,0.3,0,-1,0", "2,0.3,2.5,0,0,-1", "2.2,1.7,2.3,0,0,-1", "2,1,1,0,0,1"})
        points += std::string(point) + "\n";
    ASSERT_EQ(run_program({"probe", fine, "--points", "-", "-o", folder / "reference.csv"}, points).status, 0);

    const std::string tool = test::source_folder() + "/bench/time_to_error";
    const Finished run = RunningProgram({tool, scene, folder / "reference.csv", "--errors", "0.1", "--program",
                                         test::program(), "--no-probe-time", "--json", folder / "rows.json"},
                                        {}, "/usr/bin/python3")
                             .finish();
    ASSERT_EQ(run.status, 0) << run.err;
    const OrderedJson row = OrderedJson::parse(read_text(folder / "rows.json")).at(0);
    const OrderedJson own = OrderedJson::parse(run_program({"compare", same, folder / "reference.csv", "--json"}).out);
    EXPECT_GT(row["seconds"], 0);
    EXPECT_GT(row["memory_bytes"], 1 << 20);
    EXPECT_GT(row["error"], 1e-6);
    // Computed from tables of ten digits.
    EXPECT_NEAR(row["error"].get<double>() / own["relative_rms_error"].get<double>(), 1, 1e-4);
    EXPECT_NEAR(row["bias"].get<double>(), own["bias"].get<double>(), 1e-7);
}

}  // namespace exitance::test

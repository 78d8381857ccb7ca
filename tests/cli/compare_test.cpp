#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

using OrderedJson = nlohmann::ordered_json;

TEST(ProgramCompare, ASolutionAgreesWithItsOwnProbesAndWithAFinerOne) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), coarse = folder / "coarse.h5", fine = folder / "fine.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", coarse, "--error", "0.1", "-q"}).status, 0);
    ASSERT_EQ(run_program({"solve", scene, "-o", fine, "--error", "0.03", "-q"}).status, 0);

    const Finished probes = run_program({"probe", coarse, "--points", "-", "-o", folder / "own.csv"},
                                        "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,2,0,0,0,1\n0,1,1,1,0,0\n");
    ASSERT_EQ(probes.status, 0) << probes.err;
    const OrderedJson own = OrderedJson::parse(run_program({"compare", coarse, folder / "own.csv", "--json"}).out);
    std::vector<std::string> names;
    for (const auto& [name, value] : own.items()) names.push_back(name);
    EXPECT_EQ(names, (std::vector<std::string>{"relative_rms_error", "raw_relative_rms_error", "reference_noise",
                                               "bias", "median_relative_error", "p95_relative_error", "points"}));
    EXPECT_EQ(own["points"], 3);
    EXPECT_LT(own["relative_rms_error"], 1e-8);  // ten digits are printed

    const OrderedJson difference = OrderedJson::parse(run_program({"compare", coarse, fine, "--json"}).out);
    EXPECT_GT(difference["relative_rms_error"], 1e-4);
    EXPECT_LT(difference["relative_rms_error"], 0.15);  // the sum of both requested errors, with a margin
}

TEST(ProgramCompare, DrawsThePositionsOfErrors) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), coarse = folder / "coarse.h5", fine = folder / "fine.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", coarse, "--error", "0.2", "-q"}).status, 0);
    ASSERT_EQ(run_program({"solve", scene, "-o", fine, "--error", "0.05", "-q"}).status, 0);
    const auto map = [&](const std::string& reference, const std::string& picture) {
        return run_program({"compare", coarse, reference, "--map", picture, "--size", "64x40", "--json"});
    };
    EXPECT_EQ(map(fine, folder / "a.png").status, 0);
    ASSERT_EQ(run_program({"probe", fine, "--points", "-", "-o", folder / "own.csv"},
                          "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n3,2,0,0,0,1\n")
                  .status,
              0);
    EXPECT_EQ(map(folder / "own.csv", folder / "b.png").status, 0);
    EXPECT_NE(read_text(folder / "a.png"), read_text(folder / "b.png"));
    EXPECT_EQ(map(fine, folder / "a.jpg").status, 2);
    const OrderedJson function = OrderedJson::parse(run_program({"compare", coarse, fine, "--json"}).out);
    const OrderedJson drawn = OrderedJson::parse(run_program({"compare", coarse, fine, "--interpolant", "--json"}).out);
    EXPECT_GT(drawn["relative_rms_error"], function["relative_rms_error"]);
}

TEST(ProgramCompare, AReferenceWithoutLightIsBadInput) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n");
    EXPECT_EQ(run_program({"compare", solution, folder / "points.csv"}).status, 3);
    EXPECT_EQ(run_program({"compare", solution, folder / "absent.csv"}).status, 3);
}

}  // namespace exitance::test

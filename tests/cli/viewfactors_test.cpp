#include <gtest/gtest.h>

#include <sstream>

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
        // The floor and the lamp's front see none of the lamp's black back; 1e-4 is the tolerance by default.
        if (rows == 0 || rows == 6) {
            EXPECT_NEAR(row_sum, 1, 1e-4);
        }
    }
    EXPECT_EQ(rows, 7u);
}

TEST(ProgramViewFactors, ToleranceOutOfRangeIsAUsageErrorAndAnUnwritableFolderLeavesNoResult) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    EXPECT_EQ(run_program({"viewfactors", scene, "-o", folder / "f.csv", "--tolerance", "2"}).status, 2);
    EXPECT_EQ(run_program({"viewfactors", scene, "-o", folder / "absent/f.csv"}).status, 5);
    EXPECT_EQ(run_program({"viewfactors", write_broken_scene(folder), "-o", folder / "f.csv"}).status, 3);
}

}  // namespace exitance::test

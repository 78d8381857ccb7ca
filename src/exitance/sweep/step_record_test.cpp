#include "exitance/sweep/step_record.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Folder of a step with three files, and its record.
class StepRecords : public testing::Test {
  protected:
    StepRecords() {
        std::filesystem::create_directory(folder_ / "maps");
        for (const char* const name : {"my light.csv", "maps/a.png", "odd\n\\n.txt"})
            std::ofstream(folder_ / name) << "123";
        EXPECT_TRUE(write_step_record(folder_ / "", 4));
    }
    std::string damage_after(const std::function<void()>& change) const {
        change();
        const std::optional<StepCondition> condition = step_condition(folder_ / "");
        return condition ? condition->damage : "no folder";
    }
    TemporaryFolder folder_;
};

TEST_F(StepRecords, ACompleteFolderIsNotDamaged) {
    EXPECT_EQ(damage_after([] {}), "");
    EXPECT_EQ(step_condition(folder_ / "")->status, 4);
    EXPECT_EQ(damage_after([&] { std::ofstream(folder_ / "further.txt") << "1"; }), "");
    EXPECT_FALSE(step_condition(folder_ / "none"));
}

TEST_F(StepRecords, MissingAndTruncatedFilesAreDamage) {
    EXPECT_EQ(damage_after([&] { std::ofstream(folder_ / "my light.csv") << "12"; }),
              "my light.csv has 2 bytes, and had 3");
    EXPECT_EQ(damage_after([&] { std::ofstream(folder_ / "my light.csv") << "123"; }), "");
    EXPECT_EQ(damage_after([&] { std::filesystem::remove_all(folder_ / "maps"); }), "maps/a.png is missing");
}

TEST_F(StepRecords, EveryTruncatedRecordIsDamage) {
    std::ifstream file(folder_ / step_record_file);
    const std::string whole((std::istreambuf_iterator<char>(file)), {});
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_EQ(damage_after([&] { std::ofstream(folder_ / step_record_file) << whole.substr(0, size); }),
                  "status.txt is incomplete")
            << size;
    EXPECT_EQ(damage_after([&] { std::filesystem::remove(folder_ / step_record_file); }), "status.txt is missing");
}

}  // namespace
}  // namespace exitance

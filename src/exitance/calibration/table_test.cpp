#include "exitance/calibration/table.hpp"

#include <gtest/gtest.h>

#include <set>

namespace exitance {
namespace {

TEST(CalibrationTable, RowsAreCompleteAndUnique) {
    std::set<std::string_view> names;
    for (const CalibratedNumber& n : calibration_table()) {
        EXPECT_TRUE(names.insert(n.name).second) << n.name;
        EXPECT_GT(*n.stored, 0) << n.name;
        EXPECT_FALSE(n.unit.empty() || n.effect.empty() || n.range.empty()) << n.name;
        EXPECT_EQ(n.range == "not measured", n.command.empty()) << n.name;
    }
}

TEST(CalibrationTable, ATriedNumberIsRestoredAfterwards) {
    const CalibratedNumber* row = find_calibrated("weak_link_share");
    ASSERT_TRUE(row);
    const double own = calibrated::weak_link_share;
    {
        const TriedNumber tried(*row, 2 * own);
        EXPECT_EQ(calibrated::weak_link_share, 2 * own);
    }
    EXPECT_EQ(calibrated::weak_link_share, own);
    EXPECT_FALSE(find_calibrated("strong_link_share"));
}

}  // namespace
}  // namespace exitance

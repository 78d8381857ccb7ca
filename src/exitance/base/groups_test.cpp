#include "exitance/base/groups.hpp"

#include <gtest/gtest.h>

namespace exitance {

TEST(Groups, HoldTheirNumbersInOrder) {
    const std::uint32_t group_of[] = {2, 0, 2, 3, 0, 2};
    const Groups groups(group_of, 5);
    const auto members = [&](std::size_t g) { return std::vector(groups[g].begin(), groups[g].end()); };
    EXPECT_EQ(members(0), (std::vector<std::uint32_t>{1, 4}));
    EXPECT_EQ(members(1), (std::vector<std::uint32_t>{}));
    EXPECT_EQ(members(2), (std::vector<std::uint32_t>{0, 2, 5}));
    EXPECT_EQ(members(3), (std::vector<std::uint32_t>{3}));
    EXPECT_EQ(members(4), (std::vector<std::uint32_t>{}));
}

}  // namespace exitance

#include "exitance/io/solution/vertex_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

TEST(VertexTable, NumbersPointsInTheOrderInWhichTheyAreAdded) {
    VertexTable table;
    EXPECT_EQ(table.add({1, 2, 3}), 0u);
    EXPECT_EQ(table.add({3, 2, 1}), 1u);
    EXPECT_EQ(table.add({1, 2, 3}), 0u);
    EXPECT_EQ(table.add({1, 2, 3 + 1e-15}), 2u);
    ASSERT_EQ(table.points().size(), 3u);
    EXPECT_EQ(table.points()[1].x, 3);
}

TEST(VertexTable, KeepsTheSignOfZero) {
    VertexTable table;
    EXPECT_EQ(table.add({0.0, 0, 0}), 0u);
    EXPECT_EQ(table.add({-0.0, 0, 0}), 1u);
    EXPECT_TRUE(std::signbit(table.points()[1].x));
}

}  // namespace
}  // namespace exitance

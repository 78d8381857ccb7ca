#include "exitance/lab/studies/cell_growth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/built_scene.hpp"

namespace exitance {
namespace {

std::set<std::string> names_in(const Table& table, const char* column) {
    std::set<std::string> names;
    for (std::size_t row = 0; row < table.rows.size(); ++row) names.insert(table.text(row, column));
    return names;
}

std::size_t count_of(const Table& table, const std::string& drawing, const std::string& shape) {
    std::size_t count = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row)
        count += table.text(row, "drawing") == drawing && table.text(row, "shape") == shape;
    return count;
}

TEST(CellGrowth, DrawsNetworksAndSamplesAndMeasuresErrors) {
    CellGrowthTables tables;
    measure_cell_growth("gcr1", built_scene("gcr1"), {16, 64}, 1, tables, StopRequest());
    ASSERT_EQ(tables.results.rows.size(), 4u);
    EXPECT_EQ(names_in(tables.results, "form"), (std::set<std::string>{"classic", "improved"}));
    for (std::size_t row = 0; row < 4; ++row) {
        EXPECT_GT(tables.results.number(row, "error"), 0);
        EXPECT_LT(tables.results.number(row, "error"), 1);
        EXPECT_LE(tables.results.number(row, "cells"), tables.results.number(row, "units"));
    }
    EXPECT_GT(count_of(tables.growth, "gcr1, 64 units", "triangle"),
              count_of(tables.growth, "gcr1, 16 units", "triangle"));
    EXPECT_GT(count_of(tables.growth, "gcr1, 64 units", "dot"), 0u);
    EXPECT_EQ(count_of(tables.samples, "gcr1, 16 units", "dot"), 300u);
    EXPECT_EQ(count_of(tables.samples, "gcr1, 64 units", "dot"), 300u);
    EXPECT_EQ(names_in(tables.samples, "colour").size(), 3u);  // outlines, uniform samples, and those near errors
}

TEST(CellGrowth, FlatlandDrawsAllUnitsAndTheKernel) {
    const FlatlandGrowth grown = measure_flatland_growth({16, 64}, 1);
    EXPECT_EQ(count_of(grown.centres, "16 units", "dot"), 16u);
    EXPECT_EQ(count_of(grown.centres, "64 units", "circle"), 64u);
    EXPECT_EQ(names_in(grown.approximation, "drawing"), (std::set<std::string>{"16 units", "64 units", "the kernel"}));
    ASSERT_EQ(grown.errors.rows.size(), 6u);
    EXPECT_LT(grown.errors.number(1, "error"), grown.errors.number(0, "error"));
}

}  // namespace
}  // namespace exitance

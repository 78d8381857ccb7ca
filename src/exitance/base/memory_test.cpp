#include "exitance/base/memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {

TEST(PeakMemory, IncludesTouchedMemoryAndNeverFalls) {
    const std::size_t before = peak_memory_bytes();
    const std::vector<char> block(64u << 20, 1);
    EXPECT_EQ(block.back(), 1);
    EXPECT_GE(peak_memory_bytes(), 64u << 20);
    EXPECT_GE(peak_memory_bytes(), before);
}

TEST(ProportionalMemory, OfASingleProcessIsItsResidentMemory) {
    const std::vector<char> block(64u << 20, 1);
    EXPECT_EQ(block.back(), 1);
    EXPECT_GE(proportional_memory_bytes(), 64u << 20);
    EXPECT_LE(proportional_memory_bytes(), peak_memory_bytes());
}

TEST(ProcessorTime, IncreasesDuringWork) {
    const double before = processor_seconds();
    EXPECT_GT(before, 0);
    std::vector<std::size_t> values(1);
    while (processor_seconds() == before && values.size() < 1u << 24) values.push_back(values.size());
    EXPECT_GT(processor_seconds(), before);
}

}  // namespace exitance

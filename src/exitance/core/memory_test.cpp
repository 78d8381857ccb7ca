#include "exitance/core/memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {

TEST(PeakMemory, HoldsWhatWasTouchedAndNeverFalls) {
    const std::size_t before = peak_memory_bytes();
    const std::vector<char> block(64u << 20, 1);
    EXPECT_EQ(block.back(), 1);
    EXPECT_GE(peak_memory_bytes(), 64u << 20);
    EXPECT_GE(peak_memory_bytes(), before);
}

TEST(ProportionalMemory, OfAProcessAloneIsWhatItHolds) {
    const std::vector<char> block(64u << 20, 1);
    EXPECT_EQ(block.back(), 1);
    EXPECT_GE(proportional_memory_bytes(), 64u << 20);
    EXPECT_LE(proportional_memory_bytes(), peak_memory_bytes());
}

}  // namespace exitance

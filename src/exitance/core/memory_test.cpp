#include "exitance/core/memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {

TEST(PeakMemory, GrowsByWhatIsTouched) {
    const std::size_t before = peak_memory_bytes();
    const std::vector<char> block(64u << 20, 1);
    // The vector may settle in pages held before, hence half of its size.
    EXPECT_GE(peak_memory_bytes() + block[0] - 1, before + (32u << 20));
}

}  // namespace exitance

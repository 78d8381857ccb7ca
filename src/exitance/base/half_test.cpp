#include "exitance/base/half.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {

TEST(Half, EveryNumberIsReadBackExactly) {
    for (std::uint32_t bits = 0; bits < 0x10000u; ++bits) {
        const Half half{static_cast<std::uint16_t>(bits)};
        const float value = to_float(half);
        if ((bits & 0x7fffu) > 0x7c00u)
            EXPECT_TRUE(std::isnan(to_float(to_half(value)))) << bits;
        else
            EXPECT_EQ(to_half(value).bits, half.bits) << bits;
    }
}

TEST(Half, NumbersBetweenAreRoundedToTheNearestAndToEven) {
    for (std::uint32_t bits = 0; bits + 1 < 0x7c00u; ++bits) {
        const float low = to_float({static_cast<std::uint16_t>(bits)}),
                    high = to_float({static_cast<std::uint16_t>(bits + 1)}), middle = 0.5f * (low + high);
        const std::uint32_t even = bits % 2 == 0 ? bits : bits + 1;
        EXPECT_EQ(to_half(middle).bits, even) << bits;
        EXPECT_EQ(to_half(std::nextafter(middle, 0.0f)).bits, bits);
        EXPECT_EQ(to_half(std::nextafter(middle, high)).bits, bits + 1);
    }
    EXPECT_EQ(to_float(to_half(65504)), 65504);
    EXPECT_TRUE(std::isinf(to_float(to_half(65520))));
    EXPECT_TRUE(std::isinf(to_float(to_half(1e9f))));
    EXPECT_EQ(to_float(to_half(-0.1f)), -to_float(to_half(0.1f)));
}

}  // namespace exitance

#include "exitance/base/processor.hpp"

#include <gtest/gtest.h>

#include "exitance/base/processor_check.hpp"

namespace exitance {
namespace {

TEST(ProcessorCheck, NamesTheFirstMissingSet) {
    EXPECT_EQ(missing_set(0, 0), nullptr);
    EXPECT_EQ(missing_set(sse42 | avx | avx2, sse42 | avx | avx2 | fma), nullptr);
    EXPECT_STREQ(missing_set(sse42 | avx | avx2 | fma, sse42), "AVX");
    EXPECT_STREQ(missing_set(sse42 | avx | avx2 | fma, sse42 | avx | avx2), "FMA");
    EXPECT_STREQ(missing_set(avx512, sse42 | avx | avx2 | fma | bmi2), "AVX-512");
}

TEST(ProcessorCheck, FindsTheSetsOfThisBuildHere) {
    EXPECT_EQ(missing_set(sets_of_build, sets_of_processor()), nullptr);
}

TEST(Processor, UsesNoWiderSetThanThatOfTheProcessor) {
    EXPECT_EQ(usable(Processor::any), Processor::any);
    EXPECT_EQ(usable(Processor::fastest), this_processor());
    const unsigned sets = sets_of_processor();
    EXPECT_TRUE(this_processor() < Processor::avx2 || ((sets & avx2) != 0 && (sets & fma) != 0));
    EXPECT_TRUE(this_processor() < Processor::avx512 || (sets & avx512) != 0);
}

}  // namespace
}  // namespace exitance

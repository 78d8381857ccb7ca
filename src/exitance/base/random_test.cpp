#include "exitance/base/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace exitance {
namespace {

TEST(ScrambledSobol, FillAgreesWithSinglePointsOnAnyProcessor) {
    for (std::uint64_t seed : {1u, 77u}) {
        const ScrambledSobol points(seed);
        for (std::uint32_t first : {0u, 5u, 4096u, 0xfffffff0u})
            for (int dimension = 0; dimension < 4; ++dimension)
                for (const Processor processor : {Processor::any, Processor::avx2, Processor::fastest}) {
                    std::vector<double> many(37);
                    points.fill(first, dimension, many, processor);
                    for (std::uint32_t k = 0; k < many.size(); ++k) ASSERT_EQ(many[k], points(first + k, dimension));
                }
    }
}

TEST(ScrambledSobol, PutsOnePointIntoEveryBoxOfEqualArea) {
    constexpr std::uint32_t count = 256;
    const ScrambledSobol points(3);
    for (unsigned columns = 1; columns <= count; columns *= 2) {
        const unsigned rows = count / columns;
        std::vector<int> filled(count);
        for (std::uint32_t k = 0; k < count; ++k) {
            const auto column = static_cast<std::size_t>(points(k, 0) * columns);
            ++filled[column * rows + static_cast<std::size_t>(points(k, 1) * rows)];
        }
        for (int n : filled) ASSERT_EQ(n, 1) << columns;
    }
}

}  // namespace
}  // namespace exitance

#include "exitance/processes/dealt_unknowns.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "exitance/base/random.hpp"
#include "exitance/processes/fetched_values.hpp"

namespace exitance {

TEST(DealtUnknowns, HaveOneOwnerAndOneIndexEach) {
    for (const std::size_t processes : {1, 2, 3, 5})
        for (const std::size_t count : {0, 1, 15, 16, 17, 100, 1000}) {
            std::vector<int> owners(count, 0);
            std::size_t all = 0;
            for (std::size_t p = 0; p < processes; ++p) {
                const DealtUnknowns dealt(count, 16, processes, p);
                EXPECT_EQ(dealt.own_count(), dealt.count_of(p));
                all += dealt.own_count();
                for (std::size_t at = 0; at < dealt.own_count(); ++at) {
                    const std::size_t unknown = dealt.unknown(at);
                    ASSERT_LT(unknown, count);
                    ++owners[unknown];
                    EXPECT_EQ(dealt.place(unknown), at);
                    EXPECT_TRUE(dealt.is_own(unknown));
                    EXPECT_EQ(dealt.owner(unknown), p);
                    if (at > 0) {
                        EXPECT_GT(unknown, dealt.unknown(at - 1));
                    }
                }
            }
            EXPECT_EQ(all, count);
            EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), static_cast<std::ptrdiff_t>(count));
        }
}

TEST(DealtUnknowns, HaveALimitedNumberOfBlocks) {
    EXPECT_EQ(dealt_block(1), 16u);
    EXPECT_EQ(dealt_block(std::size_t{1} << 20), 16u);
    for (const std::size_t count : {(std::size_t{1} << 20) + 1, std::size_t{1'000'000'000}}) {
        EXPECT_LE(count / dealt_block(count), std::size_t{1} << 16);
        EXPECT_GE(count / dealt_block(count), std::size_t{1} << 14) << "enough for many processes";
    }
}

/// Sums add up blocks in order, so that they have the same bits on any number of processes.
TEST(DealtUnknowns, AreSummedBlockByBlock) {
    RandomStream random(1, Stream::mesh);
    std::vector<double> values(1000);
    for (double& v : values) v = random.uniform() - 0.5;
    double expected = 0;
    for (std::size_t first = 0; first < values.size(); first += 16) {
        double block = 0;
        for (std::size_t i = first; i < std::min(values.size(), first + 16); ++i) block += values[i];
        expected += block;
    }
    const DealtUnknowns dealt(values.size());
    EXPECT_EQ(dealt.sum<double>([&](std::size_t i) { return values[i]; }), expected);
    const std::vector<double> sums =
        dealt.sums<double>(3, [&](std::size_t i, std::size_t k) { return static_cast<double>(k + 1) * values[i]; });
    EXPECT_EQ(sums[0], expected);
    EXPECT_EQ(sums[1], 2 * expected);
    EXPECT_NEAR(sums[2], 3 * expected, 1e-12);
}

TEST(DealtUnknowns, ASingleProcessHasAllAndFetchesNothing) {
    const DealtUnknowns dealt(50, 16);
    EXPECT_FALSE(dealt.is_spread());
    std::vector<int> all(50);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(dealt.own_part(std::span<const int>(all)), all);
    std::vector<std::uint8_t> marked(50, 0);
    FetchedValues::mark(marked[7], dealt, 3);
    FetchedValues::mark(marked[7], dealt, 20);
    EXPECT_EQ(marked[7], 3) << "read by what both of two processes would have";
    const FetchedValues fetched(dealt, marked);
    EXPECT_EQ(fetched.size(), 50u);
    EXPECT_EQ(fetched.unknown_at(7), 7u);
    EXPECT_EQ(fetched.places()[49], 49u);
    const std::vector<Spectrum> values(50, Spectrum(2.0));
    EXPECT_EQ(fetched.with_fetched(values), values);
}

}  // namespace exitance

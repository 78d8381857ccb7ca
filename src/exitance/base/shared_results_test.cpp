#include "exitance/base/shared_results.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

using Blocks = std::span<std::string* const>;
std::vector<std::vector<std::string>> rounds_of_other;  // blocks of the other process, round by round
std::size_t round_number = 0;

/// `exchange` of the first of two processes: takes the blocks of the second, recorded before by record().
void replay(Blocks blocks, const char*) {
    ASSERT_LT(round_number, rounds_of_other.size());
    for (std::size_t b = 1; b < blocks.size(); b += 2)
        if (blocks[b]) *blocks[b] = rounds_of_other[round_number][b];
    ++round_number;
}
void record(Blocks blocks, const char*) {
    auto& all = rounds_of_other.emplace_back();
    for (const std::string* block : blocks) all.push_back(block ? *block : std::string());
    for (std::size_t b = 0; b < blocks.size(); b += 2)  // unknown values of the first process are read as empty vectors
        if (blocks[b]) *blocks[b] = std::string(3 * sizeof(std::uint64_t), '\0');
}

std::vector<std::vector<int>> found_by(ResultSharing sharing, std::size_t count, std::span<const double> work = {}) {
    const ResultSharing before = std::exchange(result_sharing(), sharing);
    std::vector<std::vector<int>> out(count);
    find_together(
        out, 3, [](std::size_t i) { return std::vector<int>(i % 5, static_cast<int>(i)); },
        [](auto& a, std::vector<int>& value) { a(value); }, "test", work);
    result_sharing() = before;
    return out;
}

}  // namespace

TEST(SharedResults, TwoProcessesFindTheResultsOfOne) {
    constexpr std::size_t count = 99;  // a multiple of the block size
    const std::vector<std::vector<int>> alone = found_by({}, count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(alone[i], std::vector<int>(i % 5, static_cast<int>(i)));
    rounds_of_other.clear(), round_number = 0;
    const std::vector<std::vector<int>> second = found_by({2, 1, record}, count);
    EXPECT_EQ(second[4], alone[4]) << "of its own block";
    EXPECT_NE(second[1], alone[1]) << "of the other one's";
    EXPECT_EQ(found_by({2, 0, replay}, count), alone);
    EXPECT_EQ(round_number, rounds_of_other.size());
}

TEST(SharedResults, DoNotDependOnTheDistribution) {
    constexpr std::size_t count = 99;
    std::vector<double> work(count / 3);
    for (std::size_t b = 0; b < work.size(); ++b) work[b] = b == 7 ? 100 : static_cast<double>(b % 4);
    rounds_of_other.clear(), round_number = 0;
    found_by({2, 1, record}, count, work);
    EXPECT_EQ(found_by({2, 0, replay}, count, work), found_by({}, count));
}

TEST(SharedResults, AFewBlocksAreAssignedRoundRobin) {
    for (std::size_t b = 0; b < 5; ++b) EXPECT_EQ(deal_blocks(5, {}, 4)[b], b % 4);
}

TEST(SharedResults, TheHeaviestBlocksAreBalancedByTheOthers) {
    const std::vector<double> work{1, 2, 9, 1, 3, 2, 0};
    const std::vector<std::size_t> owner = deal_blocks(work.size(), work, 2);
    std::vector<double> has(2, 0.0);
    for (std::size_t b = 0; b < work.size(); ++b) has[owner[b]] += work[b];
    EXPECT_EQ(has[owner[2]], 9);
    EXPECT_EQ(has[1 - owner[2]], 9);
    EXPECT_EQ(deal_blocks(work.size(), work, 1), std::vector<std::size_t>(work.size(), 0));
}

}  // namespace exitance

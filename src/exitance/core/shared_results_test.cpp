#include "exitance/core/shared_results.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

std::vector<std::vector<std::string>> told;  // what the other process would say, round by round
std::size_t round_number = 0;

/// Takes the part of the first of two processes; that of the second has been noted before.
void hear(std::span<std::string> blocks, const char*) {
    ASSERT_LT(round_number, told.size());
    for (std::size_t b = 1; b < blocks.size(); b += 2) blocks[b] = told[round_number][b];
    ++round_number;
}
void note(std::span<std::string> blocks, const char*) {
    told.emplace_back(blocks.begin(), blocks.end());
    for (std::size_t b = 0; b < blocks.size(); b += 2)  // what is not known yet is empty things here
        blocks[b] = std::string(3 * sizeof(std::uint64_t), '\0');
}

std::vector<std::vector<int>> found_by(ResultSharing sharing, std::size_t count) {
    const ResultSharing before = std::exchange(result_sharing(), sharing);
    std::vector<std::vector<int>> out(count);
    find_together(
        out, 3, [](std::size_t i) { return std::vector<int>(i % 5, static_cast<int>(i)); },
        [](auto& a, std::vector<int>& value) { a(value); }, "test");
    result_sharing() = before;
    return out;
}

}  // namespace

TEST(SharedResults, ThoseOfOneProcessAreFoundByTwo) {
    constexpr std::size_t count = 99;  // whole blocks
    const std::vector<std::vector<int>> alone = found_by({}, count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(alone[i], std::vector<int>(i % 5, static_cast<int>(i)));
    told.clear(), round_number = 0;
    const std::vector<std::vector<int>> second = found_by({2, 1, note}, count);
    EXPECT_EQ(second[4], alone[4]) << "of its own block";
    EXPECT_NE(second[1], alone[1]) << "of the other one's";
    EXPECT_EQ(found_by({2, 0, hear}, count), alone);
    EXPECT_EQ(round_number, told.size());
}

}  // namespace exitance

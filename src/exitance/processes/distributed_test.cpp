#include "exitance/processes/distributed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace exitance {

TEST(Distributed, ASingleProcessRunsTheWholeLoop) {
    ASSERT_EQ(processes(), 1u) << "tests are not started by a launcher";
    EXPECT_TRUE(is_first_process());
    std::vector<int> out(1000);
    shared_ranges(
        out.size(), 7,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) out[i] += static_cast<int>(i);
        },
        [&](std::size_t i) -> int& { return out[i]; }, {"test"});
    std::vector<int> expected(out.size());
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(out, expected);
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_TRUE(is_own(i, 7));
    for (const std::size_t count : {0u, 1u, 7u, 8u, 1000u}) EXPECT_EQ(own_count(count, 7), count);
    EXPECT_TRUE(traffic().empty());
}

TEST(Distributed, ASingleProcessMakesAllPartsOfAnArray) {
    const std::vector<std::uint32_t> first{0, 3, 3, 4, 10};
    std::vector<double> out(2, -1.0);
    shared_parts(out, first, 2,
                 [&](std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i)
                         for (std::uint32_t k = first[i]; k < first[i + 1]; ++k)
                             out[k] += static_cast<double>(10 * i + k);
                 },
                 {"test"});
    EXPECT_EQ(out, (std::vector<double>{0, 1, 2, 23, 34, 35, 36, 37, 38, 39}));
    EXPECT_EQ(processes_on_node(), 1u);
    EXPECT_EQ(sum_on_node(1.5), 1.5);
}

TEST(Distributed, ASingleProcessAgreesWithItself) {
    EXPECT_EQ(as_first(42), 42);
    EXPECT_EQ(as_first(std::string("word"), "test"), "word");
    EXPECT_EQ(largest_of_all(1.5), 1.5);
    EXPECT_EQ(sum_of_all(1.5), 1.5);
    const Result<void> done = by_first([] { return Result<void>(Error{ErrorCode::limit, "too much", "here", ""}); });
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "too much");
    StopRequest asked, agreed;
    const StopTogether together(asked, agreed);
    asked.set_deadline(StopRequest::Clock::now());
    EXPECT_LE(common_seconds_left(processes() > 1 ? agreed : asked), 0);
}

TEST(Distributed, ASingleProcessSharesNoMemory) {
    std::vector<double> values(1 << 20, 0.5);
    const double* const before = values.data();
    share_on_node(std::span(values));
    EXPECT_EQ(values.data(), before);
    EXPECT_EQ(std::count(values.begin(), values.end(), 0.5), 1 << 20);
    EXPECT_EQ(shared_memory_bytes(), 0u);
}

}  // namespace exitance

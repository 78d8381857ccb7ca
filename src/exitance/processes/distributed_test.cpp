#include "exitance/processes/distributed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <numeric>

#include "cli/process_runs.hpp"

namespace exitance {
namespace {

/// Environment variable that tells this program that it was started as one of two processes.
const char* const one_of_two = "EXITANCE_TEST_IS_ONE_OF_TWO";

}  // namespace

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

/// Runs as one of the two processes that the test below starts. Progress of a loop ends at 1 in each process only if a
/// process counts as many items as own_count() predicts.
TEST(Distributed, OneOfTwoProcessesCountsItsOwnItems) {
    if (!std::getenv(one_of_two)) GTEST_SKIP() << "runs in two processes, started by the next test";
    ASSERT_TRUE(join_processes());
    EXPECT_EQ(processes(), 2u);
    for (const std::size_t count : {1u, 6u, 7u, 8u, 13u, 14u, 15u, 1000u}) {
        std::vector<int> out(count);
        std::atomic<std::size_t> items{0};
        shared_ranges(
            count, 7,
            [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) out[i] += static_cast<int>(i), ++items;
            },
            [&](std::size_t i) -> int& { return out[i]; }, {"test"});
        std::vector<int> expected(count);
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(out, expected);
        EXPECT_EQ(items, own_count(count, 7)) << count;
        EXPECT_EQ(sum_of_all(static_cast<double>(items)), static_cast<double>(count));
    }
    EXPECT_EQ(as_first(own_process()), 0u);
    EXPECT_EQ(largest_of_all(static_cast<double>(own_process())), 1);
    EXPECT_FALSE(traffic().empty());
    leave_processes();
}

TEST(Distributed, TwoProcessesDivideLoops) {
    if (test::launcher.empty()) GTEST_SKIP() << "the build has no MPI";
    test::allow_any_processes();
    ::setenv(one_of_two, "1", 1);
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    const test::Finished run = test::RunningProgram({"-n", "2", self, "--gtest_color=no",
                                                     "--gtest_filter=Distributed.OneOfTwoProcessesCountsItsOwnItems"},
                                                    {}, test::launcher)
                                   .finish();
    ::unsetenv(one_of_two);
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_EQ(test::times(run.out, "[  PASSED  ] 1 test"), 2u) << run.out << run.err;
}

}  // namespace exitance

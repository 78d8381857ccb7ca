#include "exitance/base/thread_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace exitance {
namespace {

TEST(ThreadPool, CallsEveryWorkerOnceInEveryLoop) {
    ThreadPool pool(3);
    std::vector<int> calls(7);
    for (int loop = 0; loop < 1000; ++loop) pool.run(calls.size(), [&](std::size_t worker) { ++calls[worker]; });
    EXPECT_EQ(calls, std::vector<int>(7, 1000));
    pool.run(0, [](std::size_t) { FAIL(); });
}

TEST(ThreadPool, WorkersRunAtTheSameTime) {
    ThreadPool pool(2);
    std::atomic<int> present = 0;
    pool.run(2, [&](std::size_t) {  // each waits for the other
        ++present;
        while (present < 2) std::this_thread::yield();
    });
    EXPECT_EQ(present, 2);
}

TEST(ThreadPool, LoopsWithinLoopsAndRunAloneStayOnTheirThread) {
    ThreadPool pool(4);
    std::atomic<int> calls = 0;
    const auto loop_on_this_thread = [&] {
        const std::thread::id here = std::this_thread::get_id();
        pool.run(8, [&](std::size_t) {
            EXPECT_EQ(std::this_thread::get_id(), here);
            ++calls;
        });
    };
    pool.run(4, [&](std::size_t) { loop_on_this_thread(); });
    ThreadPool::run_alone(loop_on_this_thread);
    EXPECT_EQ(calls, 40);
}

TEST(ThreadPool, LoopsDoNotDisturbEachOtherOnSeveralThreads) {
    ThreadPool pool(3);
    std::vector<std::vector<int>> calls(4, std::vector<int>(5));
    std::vector<std::thread> callers;
    for (std::vector<int>& own : calls)
        callers.emplace_back([&pool, &own] {
            for (int loop = 0; loop < 500; ++loop) pool.run(own.size(), [&](std::size_t worker) { ++own[worker]; });
        });
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(calls, (std::vector<std::vector<int>>(4, std::vector<int>(5, 500))));
}

TEST(ThreadPool, ThrowsTheExceptionOfAWorkerAndCanBeUsedAgain) {
    ThreadPool pool(3);
    const auto fail = [](std::size_t worker) {
        if (worker == 1) throw std::runtime_error("no light");
    };
    EXPECT_THROW(pool.run(6, fail), std::runtime_error);
    std::atomic<int> calls = 0;
    pool.run(6, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 6);
}

}  // namespace
}  // namespace exitance

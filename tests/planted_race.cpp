#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Adds to a sum on two threads of a loop at once: each task waits for another one, in a way that orders nothing.
/// False if the loop had one thread all the time that a task waits.
bool race(std::chrono::seconds patience) {
    set_threads(4);
    std::atomic<int> arrived = 0;
    std::atomic<bool> met = false;
    volatile int sum = 0;
    parallel_for(4, 1, [&](std::size_t) {
        const auto late = std::chrono::steady_clock::now() + patience;
        const int before = arrived.fetch_add(1, std::memory_order_relaxed);
        while (arrived.load(std::memory_order_relaxed) < 2 && std::chrono::steady_clock::now() < late)
            std::this_thread::yield();
        if (before == 0 && arrived.load(std::memory_order_relaxed) >= 2) met.store(true, std::memory_order_relaxed);
        sum = sum + 1;
    });
    return met;
}

/// Else what thread_sanitizer.supp is silent about would be more than other libraries.
TEST(ThreadSanitizer, FindsARaceOfTwoThreads) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            if (!race(std::chrono::seconds(60))) {
                std::fputs("no data race: the loop had one thread\n", stderr);
                std::abort();
            }
        },
        "data race");
}

}  // namespace
}  // namespace exitance

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Adds to a sum from two threads of a parallel loop at once. Each task waits up to `patience` for another one, without
/// synchronization. Returns false if only one thread ran during that time.
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

/// Checks that thread_sanitizer.supp only suppresses reports of other libraries.
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

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "exitance/core/parallel.hpp"

namespace exitance {
namespace {

/// A sum that two threads add to: each task waits for another one, in a way that orders nothing.
void race() {
    set_threads(4);
    std::atomic<int> arrived = 0;
    volatile int sum = 0;
    parallel_for(4, 1, [&](std::size_t) {
        arrived.fetch_add(1, std::memory_order_relaxed);
        for (int k = 0; k < 10'000'000 && arrived.load(std::memory_order_relaxed) < 2; ++k) std::this_thread::yield();
        sum = sum + 1;
    });
}

/// Else what thread_sanitizer.supp is silent about would be more than other libraries.
TEST(ThreadSanitizer, FindsARaceOfTwoThreads) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(race(), "data race");
}

}  // namespace
}  // namespace exitance

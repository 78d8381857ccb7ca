#include "exitance/io/files/rehearsal.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <vector>

#include "exitance/base/sanitizers.hpp"

namespace exitance {
namespace {

TEST(Rehearsal, HasNoSideEffects) {
    int written = 0;
    EXPECT_FALSE(rehearse([&] { return ++written == 1; }, 5));
    EXPECT_EQ(written, 0);
}

TEST(Rehearsal, ReportsAFailure) {
    EXPECT_EQ(rehearse([] { return false; }, 5), "fails");
}

TEST(Rehearsal, ReportsACrash) {
    EXPECT_EQ(rehearse([] { return ::raise(SIGSEGV) == 0; }, 5), "crashes");
    EXPECT_EQ(rehearse([] { return ::raise(SIGABRT) == 0; }, 5), "crashes");
}

TEST(Rehearsal, EndsAtTheTimeLimit) {
    const auto never_ending = [] {
        for (;;) ::getppid();
        return true;
    };
    EXPECT_EQ(rehearse(never_ending, 0.5), "takes more than 1 s");
}

TEST(Rehearsal, EndsAtTheMemoryLimit) {
    if (has_address_sanitizer) GTEST_SKIP() << "memory cannot be limited below the sanitizer's";
    const auto take = [](std::size_t bytes) {
        return [bytes] {
            const std::vector<char> taken(bytes);
            return taken.back() == 0;
        };
    };
    EXPECT_EQ(rehearse(take(300 << 20), 5, 100 << 20), "needs more than 101 MiB");
    EXPECT_FALSE(rehearse(take(50 << 20), 5, 100 << 20));
}

TEST(Rehearsal, EndsAWaitingCopyAndReportsNothing) {
    const auto waits = [] {
        // Replaces the limit of elapsed time by 1 s; almost all of the limit must be left.
        const unsigned seconds_left = ::alarm(1);
        if (seconds_left >= 40 && seconds_left <= 80) ::pause();
        return false;
    };
    EXPECT_FALSE(rehearse(waits, 5));
}

TEST(Rehearsal, ReportsNothingIfTheUserEndsIt) {
    EXPECT_FALSE(rehearse([] { return ::raise(SIGTERM) == 0; }, 5));
}

}  // namespace
}  // namespace exitance

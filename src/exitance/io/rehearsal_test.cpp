#include "exitance/io/rehearsal.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

namespace exitance {
namespace {

TEST(Rehearsal, LeavesNoTraceOfWhatItDid) {
    int written = 0;
    EXPECT_FALSE(rehearse([&] { written = 1; }, 5));
    EXPECT_EQ(written, 0);
}

TEST(Rehearsal, TellsThatItCrashed) {
    EXPECT_EQ(rehearse([] { ::raise(SIGSEGV); }, 5), "crashes");
    EXPECT_EQ(rehearse([] { ::raise(SIGABRT); }, 5), "crashes");
}

TEST(Rehearsal, DoesNotGoOnForEver) {
    const auto never_ending = [] {
        for (;;) ::getppid();
    };
    EXPECT_EQ(rehearse(never_ending, 0.5), "takes more than 1 s");
}

TEST(Rehearsal, EndedByTheUserSaysNothingOfTheWork) {
    EXPECT_FALSE(rehearse([] { ::raise(SIGTERM); }, 5));
}

}  // namespace
}  // namespace exitance

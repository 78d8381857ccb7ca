#include "exitance/base/progress.hpp"

#include <gtest/gtest.h>

namespace exitance {

TEST(StopRequest, KeepsItsFirstCause) {
    StopRequest stop;
    EXPECT_EQ(stop.cause(), StopRequest::Cause::none);
    stop.interrupt(StopRequest::Cause::memory_limit);
    stop.interrupt(StopRequest::Cause::termination);
    EXPECT_EQ(stop.cause(), StopRequest::Cause::memory_limit);
    EXPECT_TRUE(stop.interrupted());
}

TEST(StopRequest, HasTheTimeLimitAsCauseAfterItsDeadline) {
    StopRequest stop;
    stop.set_deadline(StopRequest::Clock::now());
    EXPECT_EQ(stop.cause(), StopRequest::Cause::time_limit);
    EXPECT_FALSE(stop.interrupted());
}

TEST(StopRequest, TakesTheCauseThatWasAgreedOn) {
    StopRequest own, other;
    own.interrupt(StopRequest::Cause::time_limit);
    for (StopRequest* stop : {&own, &other}) {
        stop->agree_on(StopRequest::Cause::termination);
        EXPECT_EQ(stop->cause(), StopRequest::Cause::termination);
        EXPECT_TRUE(stop->requested());
    }
}

}  // namespace exitance

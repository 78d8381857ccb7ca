#include "exitance/methods/solver/body_demand.hpp"

#include <gtest/gtest.h>

#include "exitance/calibration/error_budget.hpp"

namespace exitance {
namespace {

constexpr double limit = 0.06;

/// Two bodies: one is accurate, the other has this error.
std::vector<BodyError> errors_of(double error, double standard_error) {
    return {{.error = 0.01, .first = SurfaceId(0), .at_least = 0.01},
            {.error = error, .first = SurfaceId(1), .at_least = error - standard_error}};
}

SceneBodies two_bodies() {
    SceneBodies out;
    out.all.resize(2);
    out.body.resize(2);
    out.body[SurfaceId(0)] = 0, out.body[SurfaceId(1)] = 1;
    return out;
}

TEST(BodyDemand, NeedsAnAttemptOnlyIfAnErrorExceedsTheLimitByMoreThanItsNoise) {
    EXPECT_FALSE(BodyDemand().needs_attempt(errors_of(0.05, 0.01), 0.05, limit));
    EXPECT_FALSE(BodyDemand().needs_attempt(errors_of(0.07, 0.02), 0.07, limit));
    EXPECT_TRUE(BodyDemand().needs_attempt(errors_of(0.09, 0.02), 0.09, limit));
}

TEST(BodyDemand, NeedsASecondAttemptOnlyIfTheFirstHalvedTheExcess) {
    BodyDemand demand;
    EXPECT_TRUE(demand.begin_attempt(0.10));
    EXPECT_FALSE(demand.needs_attempt(errors_of(0.09, 0), 0.09, limit));
    EXPECT_TRUE(demand.needs_attempt(errors_of(0.07, 0), 0.07, limit));
    EXPECT_FALSE(demand.begin_attempt(0.07));
    EXPECT_FALSE(demand.needs_attempt(errors_of(0.061, 0), 0.061, limit)) << "two attempts are the limit";
}

TEST(BodyDemand, TightensOnlyInaccurateBodiesAndOnlyTheCause) {
    BodyDemand demand;
    demand.resize(2);
    demand.tighten(errors_of(0.12, 0), two_bodies(), limit, BodyDemand::Cause::gathered);
    std::vector<double> gathered{1, 1};
    demand.allow_on_gathered(gathered, 0.03);
    EXPECT_DOUBLE_EQ(gathered[0], 0.03);
    EXPECT_DOUBLE_EQ(gathered[1], 0.03 * ErrorBudget(limit).next_attempt() / 0.12);
    const std::vector<double> seen = demand.allowed_on_seen_elements(0.03);
    EXPECT_EQ(seen[0], seen[1]);
    demand.tighten(errors_of(0.12, 0), two_bodies(), limit, BodyDemand::Cause::seen);
    EXPECT_DOUBLE_EQ(demand.allowed_on_seen_elements(0.03)[1], seen[1] * ErrorBudget(limit).next_attempt() / 0.12);
}

}  // namespace
}  // namespace exitance

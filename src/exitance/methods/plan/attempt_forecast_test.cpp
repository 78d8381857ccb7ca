#include "exitance/methods/plan/attempt_forecast.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace exitance {
namespace {

constexpr AttemptFacts typical_facts{.row_rays = 2e6,
                                     .gather_rays = 40e6,
                                     .certificate_rays = 3e6,
                                     .method = 0.02,
                                     .wanted = 0.005,
                                     .left = 0.3,
                                     .finer = 0.5};

TEST(AttemptForecast, CountsTheRaysOfBothWays) {
    const AttemptForecast forecast = forecast_attempt(typical_facts);
    EXPECT_EQ(forecast.steps, 2);  // 0.02 x 0.3^2 < 0.005
    EXPECT_DOUBLE_EQ(forecast.step_rays, 2 * (5e6 + 3e6));
    // Two attempts: each halves the error with twice the elements and twice the rays per element.
    EXPECT_DOUBLE_EQ(forecast.finer_rays, (8e6 + 32e6) + 2 * 43e6);
    EXPECT_TRUE(forecast.takes_steps());
}

TEST(AttemptForecast, UsesFinerElementsIfStepsReduceTheErrorTooSlowly) {
    AttemptFacts facts = typical_facts;
    for (const double left : {0.3, 0.6, 0.95, 1.0, 1.2}) {
        facts.left = left;
        EXPECT_EQ(forecast_attempt(facts).takes_steps(), left < 0.9) << left;
    }
}

TEST(AttemptForecast, UsesFinerElementsIfTheGatherIsCheapAndTheCertificateExpensive) {
    AttemptFacts facts = typical_facts;
    facts.gather_rays = 1e6, facts.row_rays = 1e4, facts.certificate_rays = 20e6, facts.left = 0.5, facts.finer = 0.2;
    EXPECT_FALSE(forecast_attempt(facts).takes_steps());
}

TEST(AttemptAims, StartAtTheRequestedErrorAndEndBelowTheLastOne) {
    const std::vector<double> aims = attempt_aims(0.02, 0.1);
    EXPECT_EQ(aims.front(), 0.02);
    EXPECT_TRUE(std::is_sorted(aims.begin(), aims.end()));
    EXPECT_LT(aims.back(), 0.1);
    EXPECT_GT(aims.back(), 0.05) << "where time is short, half of what there is is worth an attempt";
    // An error slightly above the requested one must be reduced to that, or not at all.
    EXPECT_EQ(attempt_aims(0.02, 0.021), std::vector<double>{0.02});
}

}  // namespace
}  // namespace exitance

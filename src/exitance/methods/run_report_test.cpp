#include "exitance/methods/run_report.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

SolveStatistics judged(double error, StopReason stopped_by = StopReason::none) {
    SolveStatistics statistics;
    statistics.relative_error_estimate = error, statistics.stopped_by = stopped_by;
    statistics.converged = !statistics.is_stopped();
    warn_of_useless_light(statistics);
    return statistics;
}

TEST(RunReport, WarnsOfLightThatIsARoughGuess) {
    EXPECT_TRUE(judged(0.3).warnings.empty());
    const SolveStatistics rough = judged(0.71);
    ASSERT_EQ(rough.warnings.size(), 1u);
    EXPECT_NE(rough.warnings[0].find("71% of the light: the result is a rough guess"), std::string::npos);
    EXPECT_TRUE(rough.converged);
}

TEST(RunReport, ResultsWithAnErrorAsLargeAsTheLightHaveNotConverged) {
    const SolveStatistics useless = judged(1.2);
    ASSERT_EQ(useless.warnings.size(), 1u);
    EXPECT_NE(useless.warnings[0].find("not usable"), std::string::npos);
    EXPECT_FALSE(useless.converged);
    // Divergence has a warning of its own.
    EXPECT_TRUE(judged(0.6, StopReason::divergence).warnings.empty());
}

}  // namespace
}  // namespace exitance

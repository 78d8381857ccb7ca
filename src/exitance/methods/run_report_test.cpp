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

std::string end_of(StopReason why, double whole, double room) {
    SolveStatistics s;
    s.stopped_by = why;
    s.relative_error_estimate = whole, s.relative_error_estimate_worst_room = room;
    s.rooms.resize(room > whole ? 2 : 1);
    if (why == StopReason::time_limit) s.figures = {{next_attempt_seconds, 120}, {seconds_left, 20}};
    return message_of_early_end(s, {.error = 0.05}).value_or("");
}

TEST(RunReport, AnEarlyEndHasTheReasonThatEndedTheSolve) {
    EXPECT_EQ(end_of(StopReason::time_limit, 0.016, 0.054),
              "the estimated error is 5.4% in the worst room, 1.6% in all, but 5% was requested: another attempt would "
              "take about 120 s, but 20 s are left of the time limit; allow about 100 s more, or request a larger "
              "--error");
    EXPECT_EQ(
        end_of(StopReason::iterations, 0.049, 0.049),
        "the estimated error is 4.9%, but it is not certain that all rooms and bodies are within the requested 5%: all "
        "attempts were made; request a "
        "larger --error");
    EXPECT_NE(end_of(StopReason::memory_limit, 0.02, 0.02)
                  .find("not certain that all rooms and bodies are within the requested 5%"),
              std::string::npos);
    EXPECT_NE(end_of(StopReason::memory_limit, 0.2, 0.2).find("the memory limit ended the solve"), std::string::npos);
    EXPECT_NE(end_of(StopReason::interrupt, 0.2, 0.2).find("an interrupt ended the solve"), std::string::npos);
    EXPECT_EQ(end_of(StopReason::divergence, 0.2, 0.2), "");  // has a warning of its own
}

}  // namespace
}  // namespace exitance

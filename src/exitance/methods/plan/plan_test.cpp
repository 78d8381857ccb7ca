#include "exitance/methods/plan/plan.hpp"

#include <gtest/gtest.h>

#include "exitance/methods/plan/forecast.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

TEST(Plan, ChoosesSumsAndReportsUnusedLinkOptions) {
    const Scene tube = built_scene("tube"), room = built_scene("cornell");
    const Stage open(tube), cluttered(room);
    EXPECT_TRUE(make_plan(open, {.error = 0.02}).sums);
    EXPECT_FALSE(make_plan(cluttered, {.error = 0.02}).sums);
    SolveOptions options{.method = Method::progressive};
    options.oracle = LinkOracle::power;
    EXPECT_EQ(make_plan(cluttered, options).notices.size(), 1u);
    options.keep_links = true;
    EXPECT_EQ(make_plan(cluttered, options).notices.size(), 2u);
    options.method = Method::hierarchical;
    const Plan links = make_plan(cluttered, options);
    EXPECT_TRUE(links.has_links && links.notices.empty());
}

TEST(Plan, AimsAtALargerErrorFirstIfRequested) {
    const Scene room = built_scene("cornell");
    const Stage stage(room);
    EXPECT_GT(make_plan(stage, {.error = 0.01}, 0.08).knobs.gather_noise,
              4 * make_plan(stage, {.error = 0.01}).knobs.gather_noise);
}

/// The forecast must be within a factor of two of the actual work.
TEST(Forecast, MatchesTheSolve) {
    for (const auto& [family, method] :
         {std::pair{"tube", Method::automatic}, std::pair{"cornell", Method::automatic},
          std::pair{"cornell", Method::progressive}, std::pair{"tube", Method::substructuring}}) {
        const Scene scene = built_scene(family);
        const SolveOptions options{.method = method, .error = 0.06};
        const Result<Forecast> forecast = forecast_solve(scene, options);
        ASSERT_TRUE(forecast);
        Progress progress;
        const Result<Solution> solution = solve_scene(scene, options, progress, StopRequest());
        ASSERT_TRUE(solution);
        const SolveStatistics& s = solution->statistics;
        EXPECT_EQ(forecast->method, s.method);
        const double rays = forecast->rays / static_cast<double>(s.rays),
                     elements = static_cast<double>(forecast->solve_elements + forecast->gather_elements) /
                                static_cast<double>(s.leaf_elements);
        EXPECT_TRUE(rays > 0.5 && rays < 2) << family << " " << rays;
        EXPECT_TRUE(elements > 0.5 && elements < 2) << family << " " << elements;
    }
}

/// The mesh for a millionth is never made: it has millions of elements.
TEST(Forecast, ExtrapolatesMeshesThatWouldBeTooLarge) {
    const Scene scene = built_scene("cornell");
    const Result<Forecast> fine = forecast_solve(scene, {.error = 1e-6}),
                           coarse = forecast_solve(scene, {.error = 0.01});
    ASSERT_TRUE(fine && coarse);
    EXPECT_GT(fine->solve_elements, 1'000'000u);
    EXPECT_GT(fine->solve_elements, 100 * coarse->solve_elements);
    EXPECT_GT(fine->memory_bytes, 10 * coarse->memory_bytes);
    EXPECT_GT(fine->seconds, coarse->seconds);
    EXPECT_FALSE(fine->is_at_least || coarse->is_at_least);
}

TEST(Forecast, SaysThatItsNumbersAreLowerLimitsIfTheMeshReachesItsLimit) {
    const Scene scene = built_scene("cornell");
    const Result<Forecast> whole = forecast_solve(scene, {.error = 0.05}),
                           limited = forecast_solve(scene, {.error = 0.05}, 40);
    ASSERT_TRUE(whole && limited);
    EXPECT_FALSE(whole->is_at_least);
    EXPECT_TRUE(limited->is_at_least);
    EXPECT_LT(limited->solve_elements, whole->solve_elements);
}

}  // namespace
}  // namespace exitance

#include <gtest/gtest.h>

#include "exitance/methods/plan/forecast.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "support/all_states.hpp"
#include "support/built_scene.hpp"

// Limits, checkpoints and snapshots of published forms, which the pipeline has for all of them.

namespace exitance {
namespace {

SolveOptions classical(Method method) {
    SolveOptions out{.method = method, .mesh_size = 1};
    out.classical.direct = ClassicalDirect::apart;
    return out;
}

SolveOptions with_links(std::optional<bool> gather) {
    SolveOptions out{.method = Method::hierarchical, .oracle = LinkOracle::power};
    out.classical.threshold = 0.05;
    out.classical.direct = ClassicalDirect::carried;
    out.classical.gather = gather;
    return out;
}

SolveOptions by_tasks() {
    SolveOptions out{.method = Method::hierarchical, .threshold = 0.05};
    out.task_engine = true;
    return out;
}

SolveOptions by_lines() {
    SolveOptions out{.method = Method::discontinuity, .error = 0.1};
    out.local_pass = LocalPassRule::b;
    return out;
}

Result<Solution> solve(const SolveOptions& options, CheckpointStore* store = nullptr, const ShowLight& show = {}) {
    Progress progress;
    return solve_scene(built_scene("tube", {{"rho", "0.7"}}), options, progress, StopRequest(), store, show);
}

class PublishedForms : public testing::TestWithParam<SolveOptions> {};
INSTANTIATE_TEST_SUITE_P(Forms, PublishedForms,
                         testing::Values(classical(Method::matrix), classical(Method::progressive), with_links(false),
                                         with_links(true), by_tasks(), by_lines()));

TEST_P(PublishedForms, EverySavedStateLeadsToTheSameBits) {
    const Result<Solution> whole = solve(GetParam());
    ASSERT_TRUE(whole);
    AllStates on_the_way;
    ASSERT_TRUE(solve(GetParam(), &on_the_way));
    const std::size_t count = on_the_way.states.size();
    ASSERT_GE(count, 2u);
    for (std::size_t i = 0; i < 4; ++i) {
        SCOPED_TRACE("state " + std::to_string(i * (count - 1) / 3) + " of " + std::to_string(count));
        AllStates resumed(on_the_way.states[i * (count - 1) / 3]);
        const Result<Solution> again = solve(GetParam(), &resumed);
        ASSERT_TRUE(again);
        EXPECT_LT(resumed.states.size(), count + 1) << "it does not start again";
        EXPECT_EQ(again->indirect.values, whole->indirect.values);
        EXPECT_EQ(again->interpolant.values, whole->interpolant.values);
        EXPECT_EQ(again->discontinuity.values, whole->discontinuity.values);
        EXPECT_EQ(again->statistics.relative_error_estimate, whole->statistics.relative_error_estimate);
        EXPECT_EQ(again->statistics.leaf_elements, whole->statistics.leaf_elements);
        EXPECT_EQ(again->statistics.links, whole->statistics.links);
        EXPECT_EQ(again->statistics.converged, whole->statistics.converged);
    }
}

TEST(PublishedForm, AnExceededMemoryLimitEndsRefinement) {
    SolveOptions options = with_links(false);
    const Result<Solution> whole = solve(options);
    ASSERT_TRUE(whole);
    options.memory_limit_bytes = 1;
    const Result<Solution> limited = solve(options);
    ASSERT_TRUE(limited);
    EXPECT_LT(limited->statistics.links, whole->statistics.links);
    EXPECT_EQ(limited->statistics.stopped_by, StopReason::memory_limit);
    EXPECT_FALSE(limited->statistics.converged);
    EXPECT_GT(limited->statistics.energy.absorbed, 0) << "the light found so far is delivered";
}

TEST(PublishedForm, FormsOnConstantElementsAreForecast) {
    const Scene scene = built_scene("tube", {{"rho", "0.7"}});
    for (const Method method : {Method::matrix, Method::progressive, Method::substructuring}) {
        SolveOptions options{.method = method, .mesh_size = 0.5};
        options.classical.gather = false;
        const Result<Forecast> forecast = forecast_solve(scene, options);
        ASSERT_TRUE(forecast);
        const Result<Solution> solved = solve(options);
        ASSERT_TRUE(solved);
        EXPECT_EQ(forecast->solve_elements, solved->statistics.leaf_elements);
        EXPECT_EQ(forecast->gather_elements, 0u);
        // The share of pairs that face each other is known to a few per cent.
        EXPECT_NEAR(forecast->rays / static_cast<double>(solved->statistics.rays), 1, 0.3)
            << name_in(method_names, method);
    }
}

TEST(PublishedForm, LightThatDoesNotBalanceIsReported) {
    SolveOptions coarse = with_links(false), fine = coarse;
    coarse.classical.threshold = 1e3, fine.classical.threshold = 0.005;  // W
    const auto warnings = [](const SolveOptions& options) {
        const Result<Solution> solution = solve(options);
        EXPECT_TRUE(solution);
        std::size_t count = 0;
        for (const std::string& warning : solution->statistics.warnings)
            count += warning.find("of the emitted power") != std::string::npos;
        EXPECT_EQ(count > 0, solution->statistics.energy.defect > 0.02) << solution->statistics.energy.defect;
        return count;
    };
    EXPECT_EQ(warnings(coarse), 1u);
    EXPECT_EQ(warnings(fine), 0u);
}

TEST(PublishedForm, AStopDeliversTheLightSoFar) {
    for (const SolveOptions& options : {classical(Method::progressive), with_links(true), by_tasks(), by_lines()}) {
        Progress progress;
        StopRequest stop;
        stop.interrupt();
        const Result<Solution> stopped = solve_scene(built_scene("tube", {{"rho", "0.7"}}), options, progress, stop);
        ASSERT_TRUE(stopped);
        EXPECT_EQ(stopped->statistics.stopped_by, StopReason::interrupt);
        EXPECT_FALSE(stopped->statistics.converged);
        EXPECT_FALSE(stopped->statistics.relative_error_estimate);
        EXPECT_GT(stopped->interpolant.tree.size(), 0u);
    }
}

TEST(PublishedForm, SnapshotsAreTakenAfterEveryRound) {
    SolveOptions lines = by_lines();
    lines.error = 0.03;
    for (SolveOptions options : {with_links(false), by_tasks(), lines}) {
        options.snapshots.rounds = true;
        std::size_t count = 0, with_time = 0, rays = 0;
        const Result<Solution> last = solve(options, nullptr, [&](const Solution& s) {
            EXPECT_FALSE(s.statistics.converged);
            EXPECT_GT(s.statistics.leaf_elements, 0u);
            EXPECT_FALSE(s.interpolant.values.empty());
            ++count, with_time += s.statistics.figures.at("method_seconds") > 0;
            rays = s.statistics.rays;
        });
        ASSERT_TRUE(last);
        EXPECT_GE(count, 1u);
        EXPECT_EQ(with_time, count);
        EXPECT_LE(rays, last->statistics.rays) << "no work is counted twice";
    }
}

}  // namespace
}  // namespace exitance

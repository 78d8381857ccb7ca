#include "exitance/lab/local_passes/local_pass_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/test_scenes.hpp"

namespace exitance {
namespace {

Scene floor_and_lamp() {
    return test::make({{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
                       {{{-0.3, -0.3, 1.5}, {-0.3, 0.3, 1.5}, {0.3, 0.3, 1.5}, {0.3, -0.3, 1.5}}, 5}});
}

TEST(LocalPassStudy, HasARowForEveryAccuracyAndRule) {
    LocalPassStudyOptions options;
    options.accuracies = {{"low", 0.3}, {"high", 0.15}};
    options.points = 50, options.paths = 16;
    Progress progress;
    const auto rows = run_local_pass_study(floor_and_lamp(), options, progress, StopRequest());
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 10u);
    EXPECT_GT(rows->back().leaves, rows->front().leaves);
    EXPECT_LT((*rows)[3].error, (*rows)[0].error);  // local pass d is more accurate than local pass a
    const std::string csv = local_pass_csv("floor", *rows);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);
    EXPECT_EQ(csv.find("scene,accuracy,"), 0u);
}

TEST(LocalPassStudy, AStopIsAnError) {
    Progress progress;
    StopRequest stop;
    stop.interrupt();
    EXPECT_FALSE(run_local_pass_study(floor_and_lamp(), {.points = 10, .paths = 16}, progress, stop));
    const auto rows =
        run_link_threshold_study(floor_and_lamp(), {0.0}, 0.3, {.points = 10, .paths = 16}, progress, StopRequest());
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->size(), 1u);
    EXPECT_LT(rows->front().error, 0.1);
}

}  // namespace
}  // namespace exitance

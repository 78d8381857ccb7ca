#include "exitance/base/loop_progress.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

struct Reports final : Progress {
    std::vector<double> fractions;
    std::vector<std::thread::id> threads;
    void advance(double fraction, std::string_view) override {
        fractions.push_back(fraction), threads.push_back(std::this_thread::get_id());
    }
};

TEST(LoopProgress, OnlyTheDrivingThreadReportsAndFractionsRise) {
    Reports reports;
    LoopProgress progress({&reports, 0.5, 1}, 40);
    parallel_for(40, 1, [&](std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        progress.add_one();
    });
    EXPECT_FALSE(reports.fractions.empty());
    for (const std::thread::id id : reports.threads) EXPECT_EQ(id, std::this_thread::get_id());
    for (std::size_t i = 0; i < reports.fractions.size(); ++i) {
        EXPECT_GE(reports.fractions[i], i > 0 ? reports.fractions[i - 1] : 0.5);
        EXPECT_LE(reports.fractions[i], 1);
    }
}

TEST(LoopProgress, RoundsAreHalvesOfTheRest) {
    EXPECT_EQ(fraction_before_round(0), 0);
    EXPECT_EQ(fraction_before_round(1), 0.5);
    EXPECT_EQ(fraction_before_round(3), 0.875);
}

}  // namespace
}  // namespace exitance

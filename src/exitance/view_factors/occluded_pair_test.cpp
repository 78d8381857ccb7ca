#include "exitance/view_factors/occluded_pair.hpp"

#include <gtest/gtest.h>

#include "exitance/view_factors/cluttered_pair.hpp"
#include "support/blockers.hpp"

namespace exitance {
namespace {

using Outline = std::vector<Point>;

/// The side of a table's leg, the floor below it, and two more legs.
const Outline leg = {{0, 0, 0}, {0.05, 0, 0}, {0.05, 0, 0.7}, {0, 0, 0.7}};  // faces -y
const Outline ground = {{-2, -4, 0}, {3, -4, 0}, {3, 0, 0}, {-2, 0, 0}};

struct Legs {
    ConvexBlocker near = test::box({-0.4, -0.5, 0}, {-0.3, -0.4, 0.7}), far = test::box({0.6, -1, 0}, {0.7, -0.9, 0.7});
    std::vector<const ConvexBlocker*> between = {&near, &far};
    OccludedPair pair{leg, ground, {{0, -1, 0}, 0}, {{0, 0, 1}, 0}, between};
};

TEST(OccludedExchange, UsesFewCellsAlongTheCommonEdgeOfTouchingFaces) {
    const Legs legs;
    const StopRequest stop;
    OccludedExchange lines(stop);
    ClutteredExchange halving(stop);
    bool unoccluded = true;
    const double area = 0.05 * 0.7;
    Demand demand{.relative = 1e-4, .dominating = 0.03 * area};
    const std::optional<double> value = lines(legs.pair, demand, unoccluded);
    ASSERT_TRUE(value);
    EXPECT_FALSE(unoccluded);
    const double other = halving(legs.pair, {1e-5, 0, 0, 500'000}, false, unoccluded);
    EXPECT_NEAR(*value / other, 1, 1.1e-4);  // the sum of both tolerances, 1e-4 and 1e-5
    // A cell's allowed error decreases with its area, and so does its integral. If the error due to the source's
    // nearness alone had to be below the allowance, cells along the common edge would be halved endlessly.
    EXPECT_LT(lines.evaluations, 10'000U);
}

TEST(OccludedExchange, GivesUpIfLinesCutTheReceiverIntoTooManyCells) {
    const Legs legs;
    const StopRequest stop;
    OccludedExchange lines(stop);
    bool unoccluded = true;
    Demand demand{.relative = 1e-3};
    demand.max_cells = 0;
    EXPECT_FALSE(lines(legs.pair, demand, unoccluded));
    EXPECT_EQ(lines.evaluations, 0U);
}

}  // namespace
}  // namespace exitance

#include "exitance/lab/flatland/growing_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance::flatland {
namespace {

constexpr std::size_t counts[] = {16, 64};

double smooth(double x, double y) {
    return 1 / ((x - y) * (x - y) + 1);
}

// For comparison, an independent program reached, for a similar kernel with 16 and 64 units, errors of 7% and 6.7% by
// least squares, and of 4.8% and 0.5% by normalised least squares.
TEST(GrowingLines, LearnASmoothKernelBetterByLeastSquaresThanByTheDeltaRule) {
    const auto rule = errors_of_growing_kernel(smooth, 1, counts, {.weights = CellWeights::delta_rule});
    const auto fitted = errors_of_growing_kernel(smooth, 1, counts, {.weights = CellWeights::least_squares});
    const auto normalised =
        errors_of_growing_kernel(smooth, 1, counts, {.weights = CellWeights::normalised_least_squares});
    EXPECT_LT(fitted[0], rule[0]);
    EXPECT_LT(normalised[1], rule[1] / 4);
    EXPECT_LT(normalised[1], 0.02);
}

TEST(GrowingLines, TheSameSeedGivesTheSameErrors) {
    const GrowingLinesOptions options{.weights = CellWeights::delta_rule};
    EXPECT_EQ(errors_of_growing_kernel(smooth, 1, counts, options),
              errors_of_growing_kernel(smooth, 1, counts, options));
}

TEST(GrowingLines, PicturesHaveTheErrorThatIsReported) {
    const GrowingLinesOptions options{.weights = CellWeights::delta_rule};
    const std::vector<GrownKernel> grown = grow_kernel(smooth, 1, counts, options);
    ASSERT_EQ(grown.size(), 2u);
    EXPECT_EQ(std::vector<double>({grown[0].error, grown[1].error}),
              errors_of_growing_kernel(smooth, 1, counts, options));
    constexpr std::size_t side = GrownKernel::side;
    ASSERT_EQ(grown[1].values.size(), side * side);
    double off = 0, all = 0;
    for (std::size_t j = 0; j < side; ++j)
        for (std::size_t i = 0; i < side; ++i) {
            const double right = smooth((static_cast<double>(i) + 0.5) / side, (static_cast<double>(j) + 0.5) / side);
            const double found = grown[1].values[j * side + i];
            off += (found - right) * (found - right), all += right * right;
        }
    EXPECT_NEAR(std::sqrt(off / all), grown[1].error, 1e-12);
    EXPECT_EQ(grown[1].centres.size(), 64u);
    for (const auto& centre : grown[1].centres)
        for (const double at : centre) EXPECT_TRUE(at >= 0 && at <= 1) << at;  // means of samples in [0, 1]
}

}  // namespace
}  // namespace exitance::flatland

#include "exitance/error/error_tail.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace exitance {
namespace {

TEST(ErrorTail, IsAQuantileIfAllErrorsAreKnown) {
    std::vector<WeightedError> known;
    for (int k = 1; k <= 100; ++k) known.push_back({0.01 * k, 0.01});
    // the quantile is exact to one step of the errors, 0.01
    EXPECT_NEAR(error_below(known, {0, 0}, 0.05), 0.95, 0.01 + 1e-12);
    EXPECT_NEAR(error_below(known, {0, 0}, 0.5), 0.5, 0.01 + 1e-12);
}

TEST(ErrorTail, IsNormalIfNoErrorIsKnown) {
    // expected value: table of the normal distribution
    EXPECT_NEAR(error_below({}, {2, 1}, 0.01), 2 * 2.5758293, 1e-6);
}

TEST(ErrorTail, IncludesTheOthersAboveTheLimit) {
    // Half a percent of the area has the known error 1. The quantile is then the error that another half percent of the
    // area exceeds.
    const std::vector<WeightedError> known = {{1, 0.005}};
    EXPECT_NEAR(error_below(known, {0.1, 0.995}, 0.01), 0.1 * 2.8055, 1e-3);  // erfc(2.8055 / sqrt 2) = 0.005025
    EXPECT_DOUBLE_EQ(error_below(std::vector<WeightedError>{{1, 0.02}}, {0.1, 0.98}, 0.01), 1);
}

TEST(ErrorTail, IsNotAboveTheLargestPossibleError) {
    EXPECT_NEAR(error_below({}, {2, 1}, 0.01, 2.5), 2.5, 1e-9);
}

TEST(ErrorTail, IsZeroIfAllErrorsAreZero) {
    EXPECT_EQ(error_below({}, {0, 1}, 0.01), 0);
    EXPECT_EQ(error_below(std::vector<WeightedError>{{0, 1}}, {0, 0}, 0.01), 0);
}

/// Errors that are known only by noisy measurements: a fiftieth of the area has the error `some`; the others are
/// normally distributed.
struct NoisyErrors {
    static constexpr int count = 4000;
    std::mt19937_64 random{7};
    std::normal_distribution<double> gauss;
    std::vector<double> truth;
    std::vector<WeightedError> measured;
    double mean_square = 0, noise;

    NoisyErrors(double even, double some, double noise_of_one) : noise(noise_of_one) {
        for (int k = 0; k < count; ++k) {
            truth.push_back(k < count / 50 ? some : even * gauss(random));
            const double e1 = truth.back() + noise * gauss(random), e2 = truth.back() + noise * gauss(random);
            measured.push_back({std::abs(0.5 * (e1 + e2)), 1.0 / count});
            mean_square += e1 * e2 / count;
        }
    }
    double told() {
        return error_below(measured, std::vector<unsigned>(count, 64), mean_square, 0.01,
                           [&](std::span<const std::size_t> which, unsigned factor, std::span<TwoErrors> error) {
                               // decreases with the number of rays like the error of Sobol points
                               const double left = noise * std::pow(factor, -0.75);
                               for (std::size_t i = 0; i < which.size(); ++i)
                                   for (Spectrum& e : error[i]) e = Spectrum(truth[which[i]] + left * gauss(random));
                           });
    }
    double true_p99() const {
        std::vector<double> size;
        for (double e : truth) size.push_back(std::abs(e));
        std::sort(size.begin(), size.end());
        return size[count - count / 100];
    }
};

TEST(ErrorTail, IsFoundInNoiseOfEqualSize) {
    NoisyErrors planted(0.01, 0.2, 0.1);
    ASSERT_NEAR(planted.true_p99(), 0.2, 1e-12);
    std::vector<double> size;
    for (const WeightedError& e : planted.measured) size.push_back(e.error);
    std::sort(size.begin(), size.end());
    ASSERT_GT(size[NoisyErrors::count - NoisyErrors::count / 100], 0.21);  // the first measurement is too large
    // A third of the places with 0.2 seem to have smaller errors than many others, and are not measured again. The
    // places that are represent 1.4% of the area. The limit exceeds 0.4% of it and lies below 0.2 by half of the noise
    // that remains with four times the rays, 0.025.
    EXPECT_NEAR(planted.told(), 0.2, 0.03);
}

TEST(ErrorTail, IsZeroIfNoiseHidesAllErrors) {
    // Errors far below the noise of a single place, which differs from place to place as on bright and dark surfaces.
    const std::vector<WeightedError> measured(1000, WeightedError{0.1, 1e-3});
    const auto repeated = [](std::span<const std::size_t> which, unsigned, std::span<TwoErrors> error) {
        for (std::size_t i = 0; i < which.size(); ++i)
            error[i] = {Spectrum(i == 0 ? 10 : 0.01), Spectrum(i == 0 ? -10 : 0.01)};
    };
    const double mean_square = -0.1;  // e1 e2 of the first place times its weight: also hidden by noise
    EXPECT_EQ(error_below(measured, std::vector<unsigned>(1000, 64), mean_square, 0.01, repeated), 0);
}

TEST(ErrorTail, ContainsNoNoiseIfErrorsAreSmall) {
    NoisyErrors planted(0.01, 0.01, 0.03);
    const double truth = planted.true_p99();
    EXPECT_NEAR(truth, 0.0257, 0.003);
    // Four times the rays leave a noise of 0.0075, which is subtracted, except for its variation.
    EXPECT_NEAR(planted.told(), truth, 0.35 * truth);
}

}  // namespace
}  // namespace exitance

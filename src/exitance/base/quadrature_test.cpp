#include "exitance/base/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance {
namespace {

// Weights and nodes have rounding errors of a few 1e-16 each.
constexpr double rounding = 1e-14;

TEST(GaussLegendre, IntegratesMonomialsUpToTwiceItsSizeMinusOne) {
    for (int n = 1; n <= largest_gauss_rule; ++n) {
        const LineRule rule = gauss_legendre(n);
        ASSERT_EQ(rule.size(), static_cast<std::size_t>(n));
        for (int degree = 0; degree < 2 * n; ++degree) {
            double sum = 0;
            for (std::size_t k = 0; k < rule.size(); ++k) sum += rule.weights[k] * std::pow(rule.nodes[k], degree);
            EXPECT_NEAR(sum, 1.0 / (degree + 1), rounding) << n << " points, degree " << degree;
        }
    }
}

TEST(GaussLegendre, ErrorOfTheFirstMonomialBeyondItsDegreeIsTheKnownOne) {
    const LineRule rule = gauss_legendre(3);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += rule.weights[k] * std::pow(rule.nodes[k], 6);
    EXPECT_NEAR(1.0 / 7 - sum, 1.0 / 2800, rounding);  // (n!)^4 / ((2n + 1) ((2n)!)^2)
}

TEST(SquareRule, IntegratesProductsOfMonomials) {
    for (int n : {1, 2, 5}) {
        for (int p = 0; p < 2 * n; ++p)
            for (int q = 0; q < 2 * n; ++q) {
                double sum = 0;
                for (const PlanarNode& k : square_rule(n)) sum += k.weight * std::pow(k.at.x, p) * std::pow(k.at.y, q);
                EXPECT_NEAR(sum, 1.0 / ((p + 1) * (q + 1)), rounding);
            }
    }
}

TEST(ScatteredSquareRule, IntegratesEveryMonomialUpToDegreeEight) {
    for (int p = 0; p <= 8; ++p)
        for (int q = 0; p + q <= 8; ++q) {
            double sum = 0;
            for (const PlanarNode& k : scattered_square_rule()) {
                EXPECT_GT(k.weight, 0);
                sum += k.weight * std::pow(k.at.x, p) * std::pow(k.at.y, q);
            }
            EXPECT_NEAR(sum, 1.0 / ((p + 1) * (q + 1)), rounding) << "u^" << p << " v^" << q;
        }
}

// The square of Legendre's polynomial vanishes at the 4 x 4 Gauss points, so that they integrate it to zero.
TEST(ScatteredSquareRule, IntegratesTheSquareOfLegendresPolynomialOfDegreeFour) {
    const auto square_of_legendre = [](double u) {
        const double x = 2 * u - 1, p = (35 * x * x * x * x - 30 * x * x + 3) / 8;
        return 9 * p * p;  // the mean of this function is 1
    };
    double scattered = 0, gauss = 0;
    for (const PlanarNode& k : scattered_square_rule()) scattered += k.weight * square_of_legendre(k.at.x);
    for (const PlanarNode& k : square_rule(4)) gauss += k.weight * square_of_legendre(k.at.x);
    EXPECT_NEAR(scattered, 1, rounding);
    EXPECT_NEAR(gauss, 0, rounding);
}

TEST(TriangleRule, IntegratesEveryMonomialUpToItsDegree) {
    for (int degree = 0; degree <= 14; ++degree)
        for (int p = 0; p <= degree; ++p)
            for (int q = 0; p + q <= degree; ++q) {
                double sum = 0;
                for (const PlanarNode& k : triangle_rule(degree)) {
                    EXPECT_GT(k.weight, 0);
                    sum += k.weight * std::pow(k.at.x, p) * std::pow(k.at.y, q);
                }
                const double exact = 2 * std::tgamma(p + 1) * std::tgamma(q + 1) / std::tgamma(p + q + 3);
                EXPECT_NEAR(sum, exact, rounding) << "degree " << degree << ": u^" << p << " v^" << q;
            }
}

}  // namespace
}  // namespace exitance

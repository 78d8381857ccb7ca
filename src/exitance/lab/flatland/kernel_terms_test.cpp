#include "exitance/lab/flatland/kernel_terms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace exitance::flatland {
namespace {

double smooth_kernel(double x, double y) {
    return 1 / ((x - y) * (x - y) + 1);
}
double stepped(double x, double y) {
    return x > y ? smooth_kernel(x, y) : 0;
}

/// Slope of log error over log m, between two counts in the asymptotic range.
double slope(LineBasis basis, Decomposition way, const std::function<double(double, double)>& kernel,
             std::size_t small_m, std::size_t large_m, int levels = 7) {
    const KernelTerms terms(basis, way, levels, kernel);
    const std::vector<double> e = terms.errors(std::vector<std::size_t>{small_m, large_m});
    return std::log(e[1] / e[0]) / std::log(static_cast<double>(large_m) / static_cast<double>(small_m));
}

TEST(KernelTerms, AllTermsReconstructTheKernel) {
    for (const LineBasis basis : line_bases)
        for (const Decomposition way : {Decomposition::standard, Decomposition::non_standard}) {
            const KernelTerms terms(basis, way, 6, stepped);
            const std::size_t all = terms.size();
            EXPECT_LT(terms.errors({&all, 1})[0], 1e-12) << name_of(basis);  // rounding of six steps in each direction
        }
}

TEST(KernelTerms, APolynomialOfTheBasisHasNoDetails) {
    for (const LineBasis basis : line_bases) {
        const std::size_t k = TwoScaleStep(basis).order();
        const auto power = [&](double x, double y) {
            return std::pow(x, static_cast<double>(k - 1)) + (k > 1 ? y : 0);
        };
        const KernelTerms terms(basis, Decomposition::standard, 5, power);
        EXPECT_LT(terms.errors(std::vector<std::size_t>{k * k})[0], 1e-12) << name_of(basis);
    }
}

TEST(KernelTerms, FlatletsHaveVanishingMoments) {
    for (const LineBasis basis : {LineBasis::flatlet2, LineBasis::flatlet3}) {
        const TwoScaleStep step(basis);
        const std::size_t k = step.order();
        std::vector<double> fine(2 * k), out(2 * k);
        for (std::size_t i = 0; i < 2 * k; ++i) {  // the means of x^(k-1) over the boxes
            const double lo = static_cast<double>(i), power = static_cast<double>(k);
            fine[i] = (std::pow(lo + 1, power) - std::pow(lo, power)) / power;
        }
        step.analyse(fine.data(), out.data());
        for (std::size_t i = k; i < 2 * k; ++i) EXPECT_NEAR(out[i], 0, 1e-12);
    }
}

/// Theory for smooth kernels: with m ~ 4^j terms of one level the error falls as 2^(-jk), hence as m^(-k/2)
/// [Gortler93]. The tolerance of a quarter allows for counts that are not yet asymptotic.
TEST(KernelTerms, NonStandardTermsDecayWithTheOrderWhereTheKernelIsSmooth) {
    EXPECT_NEAR(slope(LineBasis::haar, Decomposition::non_standard, smooth_kernel, 100, 1600), -0.5, 0.25);
    EXPECT_NEAR(slope(LineBasis::multiwavelet2, Decomposition::non_standard, smooth_kernel, 100, 1600), -1.0, 0.25);
    EXPECT_NEAR(slope(LineBasis::multiwavelet3, Decomposition::non_standard, smooth_kernel, 150, 1600), -1.5, 0.35);
}

/// A jump along the diagonal crosses 2^j elements of level j, whose terms together have a norm of 2^(-j/2): m^(-1/2)
/// for any order.
TEST(KernelTerms, AStepReducesTheOrder) {
    for (const LineBasis basis : {LineBasis::haar, LineBasis::multiwavelet2, LineBasis::multiwavelet3})
        EXPECT_NEAR(slope(basis, Decomposition::non_standard, stepped, 100, 600, 9), -0.5, 0.25) << name_of(basis);
}

TEST(KernelTerms, MoreTermsAreNeverWorseInAnOrthonormalBasis) {
    const std::vector<std::size_t> counts{1, 4, 16, 64, 256, 1024};
    for (const LineBasis basis : {LineBasis::haar, LineBasis::multiwavelet2, LineBasis::multiwavelet3})
        for (const Decomposition way : {Decomposition::standard, Decomposition::non_standard}) {
            const std::vector<double> e = KernelTerms(basis, way, 6, stepped).errors(counts);
            for (std::size_t i = 1; i < e.size(); ++i) EXPECT_LE(e[i], e[i - 1]);
        }
}

}  // namespace
}  // namespace exitance::flatland

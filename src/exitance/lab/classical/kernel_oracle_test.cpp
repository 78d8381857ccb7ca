#include "exitance/lab/classical/kernel_oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/lab/classical/classical.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Two parallel squares of side h that face each other at a distance of 1 m, the source moved sideways by 0.7 m.
std::pair<Patch, Patch> squares(double h, double scale = 1) {
    const double s = scale;
    return {Patch{{0, 0, 0}, {h * s, 0, 0}, {0, h * s, 0}, Patch::Shape::parallelogram},
            Patch{{0.7 * s, 0.2 * s, s}, {0, h * s, 0}, {h * s, 0, 0}, Patch::Shape::parallelogram}};
}

/// Two triangles placed as the squares are.
std::pair<Patch, Patch> triangles(double h) {
    auto [p, q] = squares(h);
    p.shape = q.shape = Patch::Shape::triangle;
    return {p, q};
}

TEST(KernelOracle, HaarsMisfitIsTheMeanDifferenceFromTheKernelOfTheMiddles) {
    const NodalBasis haar(HierarchyBasis::haar);
    const auto [p, q] = squares(0.5);
    const auto kernel = [](const Point& x, const Point& y) {
        const double r2 = squared_norm(y - x);
        return (y.z - x.z) * (y.z - x.z) / (pi * r2 * r2);
    };
    const double middle = kernel(p.centre(), q.centre());
    double sum = 0;
    for (const PlanarNode& a : square_rule(2))
        for (const PlanarNode& b : square_rule(2))
            sum += a.weight * b.weight * std::abs(kernel(p.at(a.at), q.at(b.at)) - middle);
    const KernelOracle::Misfit found = KernelOracle(haar).misfit(p, q);
    EXPECT_NEAR(found.difference, sum, 1e-14);
    EXPECT_NEAR(found.mean, middle, 1e-14);
}

TEST(KernelOracle, TheMisfitFallsWithTheOrderOfTheBasis) {
    // Halved elements have 2^-M of the misfit; higher terms of the expansion change that by a tenth at this size.
    const std::pair<HierarchyBasis, double> bases[] = {{HierarchyBasis::haar, 1},
                                                       {HierarchyBasis::multiwavelet2, 2},
                                                       {HierarchyBasis::flatlet2, 2},
                                                       {HierarchyBasis::multiwavelet3, 3}};
    for (const auto& [kind, order] : bases) {
        const NodalBasis basis(kind);
        const KernelOracle oracle(basis);
        for (const auto make : {+[](double h) { return squares(h); }, +[](double h) { return triangles(h); }}) {
            const auto misfit = [&](double h) {
                const auto [p, q] = make(h);
                return oracle.misfit(p, q).difference;
            };
            EXPECT_NEAR(std::log2(misfit(0.05) / misfit(0.025)), order, 0.1 * order) << static_cast<int>(kind);
        }
    }
}

TEST(KernelOracle, StrengthsScaleWithAreas) {
    const NodalBasis basis(HierarchyBasis::multiwavelet2);
    const KernelOracle oracle(basis);
    const auto [p, q] = squares(0.5);
    const auto [large_p, large_q] = squares(0.5, 3);
    for (const double share : {0.0, 0.3, 1.0})
        EXPECT_NEAR(oracle.strength(large_p, large_q, share) / oracle.strength(p, q, share), 9, 1e-9);
    EXPECT_GT(oracle.strength(p, q, 0.5), oracle.strength(p, q, 1));
}

}  // namespace
}  // namespace exitance

#include "exitance/lab/growing_cells/growing_cells.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

std::vector<double> first_corners(std::size_t k, std::size_t n, RandomStream& random) {
    std::vector<double> out((k + 1) * n);
    for (double& v : out) v = random.uniform();
    return out;
}

TEST(CellComplex, StaysValidInEveryDimensionAfterSplitsAndRemovals) {
    for (std::size_t k = 1; k <= 4; ++k) {
        RandomStream random(k, Stream::mesh);
        CellComplex complex(k);
        for (int step = 0; step < 60; ++step) {
            const auto any = [&] {
                for (;;)
                    if (const auto u = static_cast<CellComplex::Unit>(random.uniform() * double(complex.unit_end()));
                        complex.has_unit(u))
                        return u;
            };
            if (step % 5 == 4 && complex.unit_count() > k + 6) {
                const std::size_t before = complex.unit_count(), gone = complex.remove(any()).size();
                EXPECT_EQ(complex.unit_count(), before - gone);
            } else {
                const CellComplex::Unit a = any();
                const auto around = complex.neighbours(a);
                const CellComplex::Unit b = around[static_cast<std::size_t>(random.uniform() * double(around.size()))];
                const std::size_t simplices = complex.simplex_count(), cut = complex.simplices_of_edge(a, b);
                const CellComplex::Unit middle = complex.split_edge(a, b);
                EXPECT_EQ(complex.simplex_count(), simplices + cut);
                EXPECT_EQ(complex.simplices_of_edge(a, b), 0u);
                EXPECT_EQ(complex.simplices_of_edge(a, middle), cut);
            }
            ASSERT_TRUE(complex.is_valid()) << "dimension " << k << ", step " << step;
        }
    }
}

TEST(CellComplex, TheLastSimplexIsKept) {
    CellComplex complex(2);
    EXPECT_TRUE(complex.remove(1).empty());
    EXPECT_EQ(complex.unit_count(), 3u);
    EXPECT_TRUE(complex.is_valid());
}

TEST(GrowingCells, TheWinnerIsTheNearestUnit) {
    for (const std::size_t n : {std::size_t(2), std::size_t(6)}) {
        RandomStream random(5, Stream::mesh, n);
        GrowingCells cells({.simplex = 2, .dimension = n}, first_corners(2, n, random));
        std::vector<double> x(n);
        for (int step = 0; step < 4000; ++step) {
            for (double& v : x) v = random.uniform();
            if (step % 7 == 0) {
                double least = HUGE_VAL;
                GrowingCells::Unit nearest = 0;
                for (const GrowingCells::Unit u : cells.units()) {
                    double d = 0;
                    for (std::size_t i = 0; i < n; ++i) d += std::pow(cells.position(u)[i] - x[i], 2);
                    if (d < least) least = d, nearest = u;
                }
                ASSERT_EQ(cells.winner(x), nearest);
            }
            cells.learn(x, {}, 1, 0);
            if (step % 40 == 39) cells.insert();
        }
    }
}

/// Samples from two separate squares: units in between receive nothing and are removed, which leaves two networks
/// [Fritzke94].
TEST(GrowingCells, TwoClustersSeparate) {
    RandomStream random(3, Stream::mesh);
    GrowingCells cells({.simplex = 2, .dimension = 2}, first_corners(2, 2, random));
    std::size_t gone = 0;
    for (int step = 0; step < 20000; ++step) {
        const double x = random.uniform(), y = random.uniform();
        const double sample[] = {x < 0.5 ? 0.5 * x : 2 + 0.5 * x, 0.4 * y};
        cells.learn(sample, {}, 1, 0);
        if (step % 200 == 199) cells.insert();
        if (step % 1000 == 999) gone += cells.remove_idle(0.09);
    }
    EXPECT_TRUE(cells.complex().is_valid());
    EXPECT_GE(cells.complex().component_count(), 2u);
    EXPECT_GT(gone, 0u);
    for (const GrowingCells::Unit u : cells.units()) {
        const double x = cells.position(u)[0];
        EXPECT_TRUE(x < 0.6 || x > 1.9) << "a unit is left at x = " << x;
    }
}

TEST(GrowingCells, UnitsCoverASquareEvenly) {
    RandomStream random(7, Stream::mesh);
    GrowingCells cells({.simplex = 2, .dimension = 2}, first_corners(2, 2, random));
    for (int step = 0; step < 20000; ++step) {
        const double sample[] = {random.uniform(), random.uniform()};
        cells.learn(sample, {}, 1, 0);
        if (step % 200 == 199) cells.insert();
    }
    std::vector<int> won(cells.complex().unit_end(), 0);
    for (int i = 0; i < 20000; ++i) {
        const double sample[] = {random.uniform(), random.uniform()};
        ++won[cells.winner(sample)];
    }
    for (const GrowingCells::Unit u : cells.units()) EXPECT_LT(won[u], 4 * 20000 / int(cells.unit_count()));
}

TEST(GrowingCells, OutputsFollowAFunction) {
    RandomStream random(11, Stream::mesh);
    GrowingCells cells({.simplex = 2, .dimension = 2, .outputs = 1, .normalised = true}, first_corners(2, 2, random));
    const auto f = [](double x, double y) { return std::sin(3 * x) + y; };
    for (int step = 0; step < 20000; ++step) {
        const double x = random.uniform(), y = random.uniform(), sample[] = {x, y}, target[] = {f(x, y)};
        cells.learn(sample, target, 1, 1);
        if (step % 200 == 199) cells.insert();
    }
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
        const double x = random.uniform(), y = random.uniform(), sample[] = {x, y};
        double out[1];
        cells.evaluate(sample, out);
        sum += std::pow(out[0] - f(x, y), 2) / 1000;
    }
    EXPECT_LT(std::sqrt(sum), 0.06);  // the function varies by 1.7; a constant has an error of 0.45
}

}  // namespace
}  // namespace exitance

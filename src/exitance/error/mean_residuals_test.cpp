#include "exitance/error/mean_residuals.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// A unit square, divided into quarters recursively.
struct CutSquare {
    ElementTree tree;
    LeafNumbering numbering;
    std::vector<std::uint32_t> group;

    explicit CutSquare(int levels) {
        tree.add_root(RegionId(0), {.origin = {0, 0, 0}, .a = {1, 0, 0}, .b = {0, 1, 0}});
        for (int level = 0; level < levels; ++level)
            for (ElementId e : tree.leaves()) tree.split(e, Cut::both);
        numbering = LeafNumbering(tree);
        group.assign(numbering.leaves.size(), 0);
    }

    bool is_in_corner(std::size_t leaf) const {
        const Point p = tree.patch(numbering.leaves[leaf]).centre();
        return p.x < 0.25 && p.y < 0.25;
    }
    /// Returns samples in one of `every` leaves, chosen at random: noise, plus `in_corner` in a corner of 1/16 of the
    /// square.
    std::vector<LeafResidual> samples(std::size_t every, double in_corner, double noise, std::uint64_t seed) const {
        std::vector<LeafResidual> out;
        for (std::size_t i = 0; i < numbering.leaves.size(); ++i) {
            RandomStream random(seed, Stream::reference, i);
            const double error = noise * (random.uniform() - 0.5);
            if (random.uniform() * static_cast<double>(every) < 1)
                out.push_back(
                    {static_cast<std::uint32_t>(i), 0, 1, Spectrum((is_in_corner(i) ? in_corner : 0) + error)});
        }
        return out;
    }
    std::vector<Spectrum> means(const std::vector<LeafResidual>& samples) const {
        return mean_residuals(tree, numbering, group, 1, samples);
    }
};

TEST(MeanResiduals, OfLeavesWithoutSamplesFollowTheirNeighbours) {
    const CutSquare square(5);
    const std::vector<Spectrum> told = square.means(square.samples(4, 1, 0, 1));
    double in_corner = 0, elsewhere = 0;
    for (std::size_t i = 0; i < told.size(); ++i)
        (square.is_in_corner(i) ? in_corner : elsewhere) += std::abs(mean(told[i]) - (square.is_in_corner(i) ? 1 : 0));
    const double leaves = static_cast<double>(told.size());
    EXPECT_LT(in_corner / leaves * 16,
              // The corner has a sixteenth of the leaves. With the mean of the whole square, this would be 0.94.
              0.1);
    EXPECT_LT(elsewhere / leaves, 0.03);
}

TEST(MeanResiduals, OfNoiseAreSmall) {
    const CutSquare square(5);
    double square_of_means = 0, square_of_samples = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const std::vector<LeafResidual> samples = square.samples(4, 0, 1, seed);
        for (const Spectrum& m : square.means(samples)) square_of_means += mean(m * m) / 1024;
        for (const LeafResidual& s : samples)
            square_of_samples += mean(s.residual * s.residual) / static_cast<double>(samples.size());
    }
    EXPECT_LT(square_of_means, 0.1 * square_of_samples);
}

TEST(MeanResiduals, OfGroupsAreIndependent) {
    CutSquare square(2);
    std::vector<LeafResidual> samples;
    for (std::uint32_t i = 0; i < 16; ++i) {
        square.group[i] = i % 2;
        for (int k = 0; k < 64; ++k) samples.push_back({i, i % 2, 1, Spectrum(i % 2 == 0 ? 1.0 : -1.0)});
    }
    const std::vector<Spectrum> told = mean_residuals(square.tree, square.numbering, square.group, 2, samples);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(mean(told[i]), i % 2 == 0 ? 1 : -1, 0.01);
}

TEST(MeanResiduals, OfNoSamplesAreZero) {
    const CutSquare square(1);
    for (const Spectrum& m : square.means({})) EXPECT_EQ(mean(m), 0);
}

}  // namespace
}  // namespace exitance

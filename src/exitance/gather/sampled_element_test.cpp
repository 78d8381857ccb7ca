#include "exitance/gather/sampled_element.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// A square and a triangle, with f plus noise of a given standard deviation at the nodes of a rule.
struct Noisy {
    ElementTree tree;
    std::vector<WeightedPlace> places;
    std::vector<Gathered> gathered;

    template <class Function>
    Noisy(Patch::Shape shape, const Function& f, double deviation, std::uint64_t seed, bool curved = true) {
        tree.add_root(RegionId(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, shape});
        places = element_rule(tree, ElementId(0), rule_order(curved));
        RandomStream random(seed, Stream::mesh);
        for (const WeightedPlace& p : places) {
            const double uniform = 2 * random.uniform() - 1;  // uniform random number of variance 1/3
            gathered.push_back(
                {Spectrum(f(p.uv) + deviation * std::sqrt(3.0) * uniform), Spectrum(deviation * deviation), {}});
        }
    }
    SampledElement fit(bool curved = true) const {
        return fit_gathered(tree, ElementId(0), places, gathered, Spectrum(0.5), curved, 1);
    }
};

double parabola(Vec2 p) {
    return 1 + p.x - p.y * p.y;
}

TEST(SampledElement, RepresentsACurveWithoutMisfit) {
    for (const auto shape : {Patch::Shape::parallelogram, Patch::Shape::triangle}) {
        const Noisy exact(shape, parabola, 0, 1);
        const SampledElement s = exact.fit();
        EXPECT_NEAR(s.misfit_squared, 0, 1e-20);
        EXPECT_NEAR(SampledFunction(exact.tree, ElementId(0), s).at({0.2, 0.7})[0], parabola({0.2, 0.7}), 1e-6);
        EXPECT_GT(Noisy(shape, parabola, 0, 1, false).fit(false).misfit_squared, 1e-5);
    }
}

TEST(SampledElement, IsNotNoisierDueToAbsentCurvature) {
    // Uniform light: little more than the noise of four out of nine coefficients may remain, and noise_squared must
    // agree.
    double error = 0, told = 0, straight = 0;
    constexpr int seeds = 400;
    for (int seed = 0; seed < seeds; ++seed) {
        const Noisy even(
            Patch::Shape::parallelogram, [](Vec2) { return 1.0; }, 0.1, static_cast<std::uint64_t>(seed));
        const SampledElement s = even.fit();
        told += s.noise_squared / seeds;
        const SampledFunction f(even.tree, ElementId(0), s);
        for (const WeightedPlace& p : even.places) error += p.weight * std::pow(0.5 * (f.at(p.uv)[0] - 1), 2) / seeds;
        straight += even.fit(false).noise_squared / seeds;
    }
    EXPECT_LT(error, 1.5 * straight);  // without shrinking, the error would be 9/4 of `straight`
    EXPECT_NEAR(error, told, 0.15 * told);
}

TEST(SampledElement, FollowsThePlacesThatCanBeSeen) {
    const auto line = [](Vec2 p) { return 1 + p.x - 0.5 * p.y; };
    for (const auto shape : {Patch::Shape::parallelogram, Patch::Shape::triangle})
        for (const bool curved : {false, true})
            for (std::size_t below = 0; below < 4; ++below) {  // a leg that hides one place, or two
                Noisy exact(shape, line, 0, 1, curved);
                std::vector<bool> hidden(exact.places.size(), false);
                for (const std::size_t i : {below, 2 * below}) hidden[i] = true, exact.gathered[i] = {};
                EXPECT_GT(exact.fit(curved).misfit_squared, 1e-3);
                continue_below(exact.tree, ElementId(0), exact.places, hidden, curved, exact.gathered);
                const SampledElement s = exact.fit(curved);
                EXPECT_LT(s.misfit_squared, 1e-5);
                EXPECT_NEAR(SampledFunction(exact.tree, ElementId(0), s).at({0.2, 0.7})[0], line({0.2, 0.7}), 0.02);
            }
}

TEST(SampledElement, StaysDarkIfNoPlaceCanBeSeen) {
    Noisy dark(
        Patch::Shape::parallelogram, [](Vec2) { return 0.0; }, 0, 1);
    continue_below(dark.tree, ElementId(0), dark.places, std::vector<bool>(dark.places.size(), true), true,
                   dark.gathered);
    EXPECT_EQ(dark.fit().light, 0);
}

TEST(SampledElement, IsSplitIntoLinearElementsWithinTheTolerance) {
    for (const auto shape : {Patch::Shape::parallelogram, Patch::Shape::triangle}) {
        const Noisy exact(shape, parabola, 0, 1);
        ElementFunction out;
        out.tree = exact.tree;
        const SampledElement s = exact.fit();
        constexpr double tolerance = 0.002;  // splits four times: a quarter of the misfit each time
        const std::vector<StraightLeaf> leaves = add_straight(
            out, out.tree.leaves(), [&](ElementId) -> const SampledElement& { return s; },
            [](ElementId) { return Spectrum(0.5); }, [](ElementId) { return tolerance; });
        EXPECT_EQ(leaves.size(), out.tree.leaves().size());
        EXPECT_GT(leaves.size(), 3u);
        double square = 0;
        for (const auto [e, whole] : leaves) {
            EXPECT_EQ(whole, ElementId(0));
            for (const WeightedPlace& p : element_rule(out.tree, e, RuleOrder::finer)) {
                const Vec2 uv = exact.tree.patch(ElementId(0)).coordinates(out.tree.patch(e).at(p.uv));
                square += out.tree.area(e) * p.weight * std::pow(0.5 * (out.at({e, p.uv})[0] - parabola(uv)), 2);
            }
        }
        EXPECT_LT(std::sqrt(square / out.tree.area(ElementId(0))), 1.05 * tolerance);
    }
}

}  // namespace
}  // namespace exitance

#include "exitance/reconstruct/quick_function.hpp"

#include <gtest/gtest.h>

#include "exitance/core/random.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

TEST(QuickFunction, HasTheValuesOfTheFunction) {
    const Solution solution = sample_solution(200);
    const ElementFunction& function = solution.interpolant;
    const std::size_t regions = solution.scene.regions().size();
    const QuickFunction quick(function, regions);
    const ElementLocator locator(function.tree, regions);
    RandomStream random(1, Stream::mesh);
    for (int i = 0; i < 2000; ++i) {
        const ElementId root = function.tree.roots()[random.bits() % function.tree.roots().size()];
        const Patch& patch = function.tree.patch(root);
        const double s = random.uniform(), t = random.uniform();
        const Point p = patch.at(uniform_in_shape(patch.shape, s, t));
        const RegionId region = function.tree.region(root);
        const Spectrum expected = function.at(locator.find(region, p));
        const HitPoint hit{region, p};
        Spectrum found;
        quick.read(std::span(&hit, 1), std::span(&found, 1));
        for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(found[b], expected[b], 3e-5);  // single precision, of 30
    }
}

}  // namespace
}  // namespace exitance

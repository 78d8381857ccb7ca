#include "exitance/evaluate/quick_function.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"
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
        const RayEnd hit{p, region};
        Spectrum found;
        quick.read(std::span(&hit, 1), std::span(&found, 1));
        // Single precision of values up to 30.
        for (std::size_t b = 0; b < bands; ++b) EXPECT_NEAR(found[b], expected[b], 3e-5);
    }
}

TEST(QuickFunction, HasTheSameValuesOnTrianglesThatTheFinderDoesNotStore) {
    ElementFunction function;
    function.tree.add_root(RegionId(0), {{0, 0, 0}, {3, 0.2, 0}, {0.5, 1, 0}, Patch::Shape::parallelogram});
    for (std::uint32_t e = 0; function.tree.size() < 50000; ++e) function.tree.split(ElementId(e), Cut::both);
    for (ElementId leaf : function.tree.leaves()) {
        std::vector<Vec2> border = function.tree.domain(leaf);
        border.push_back(border[0]);
        function.tree.split_fan(leaf, {function.tree.centre(leaf), border});
    }
    RandomStream random(3, Stream::mesh);
    function.first_value.resize(function.tree.size());
    for (ElementId leaf : function.tree.leaves()) {
        function.first_value[leaf] = static_cast<std::uint32_t>(function.values.size());
        for (int i = 0; i < 3; ++i) function.add_value(Spectrum(random.uniform()));
    }
    ElementFunction stored = function;
    stored.tree.add_root(RegionId(1), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::triangle});
    stored.first_value.resize(stored.tree.size());
    const LeafFinder finder(function.tree), of_stored_tree(stored.tree);
    ASSERT_LT(finder.own_leaves(), finder.size());
    ASSERT_EQ(of_stored_tree.own_leaves(), of_stored_tree.size());
    const QuickFunction quick(function, 2), of_stored(stored, 2);
    for (int i = 0; i < 500; ++i) {
        const double s = random.uniform(), t = random.uniform();
        const RayEnd hit{function.tree.patch(ElementId(0)).at(s, t), RegionId(0)};
        Spectrum a, b;
        quick.read(std::span(&hit, 1), std::span(&a, 1));
        of_stored.read(std::span(&hit, 1), std::span(&b, 1));
        for (std::size_t k = 0; k < bands; ++k) EXPECT_EQ(a[k], b[k]);  // same bits
    }
}

}  // namespace
}  // namespace exitance

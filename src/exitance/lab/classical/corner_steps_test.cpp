#include "exitance/lab/classical/corner_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "exitance/lab/classical/classical.hpp"
#include "exitance/methods/light/vertex_averages.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

/// Largest difference between corners of a leaf of a function made by `averaged_at_vertices`.
double step_of(const ElementFunction& f, ElementId e) {
    double largest = 0;
    for (std::size_t b = 0; b < bands; ++b) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (int k = 0; k < f.tree.patch(e).corner_count(); ++k) {
            const double v = f.at({e, f.tree.patch(e).corner_uv(k)})[b];
            lo = std::min(lo, v), hi = std::max(hi, v);
        }
        largest = std::max(largest, hi - lo);
    }
    return largest;
}

TEST(CornerSteps, EqualThoseOfRecomputedAveragesWhileElementsAreCut) {
    const Scene scene = built_scene("table", {{"rot", "31.7,0.3,0.5,1"}});
    const Stage stage(scene);
    const double rounding = 1e-6 * scene.size();
    ElementTree tree = make_mesh(stage.pieces, stage.concave, {.edge = 0.5});
    CornerSteps steps(rounding);
    std::vector<ElementId> elements;
    std::vector<Spectrum> values;
    const auto add_leaves = [&](std::size_t first) {
        for (std::size_t i = first; i < tree.size(); ++i) {
            const ElementId e(i);
            if (!tree.is_leaf(e)) continue;
            steps.add(tree.region(e), tree.patch(e));
            elements.push_back(e);
            const auto x = static_cast<double>(i);
            values.push_back(Spectrum(std::sin(0.37 * x) + 0.1 * std::cos(2.1 * x)));
        }
    };
    add_leaves(0);
    for (int round = 0; round < 3; ++round) {
        std::vector<ElementId> leaves;
        std::vector<Spectrum> of_leaves;
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (tree.is_leaf(elements[i])) leaves.push_back(elements[i]), of_leaves.push_back(values[i]);
        const ElementFunction anew = averaged_at_vertices(constant_function(tree, leaves, of_leaves), rounding);
        const std::size_t size = tree.size(), count = elements.size();
        constexpr double limit = 0.4;
        const auto value = [&](std::size_t i) { return values[i]; };
        const std::vector<std::size_t> steep = steps.steeper_than(limit, 0, value);
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < count; ++i)
            if (tree.is_leaf(elements[i]) && step_of(anew, elements[i]) > limit) expected.push_back(i);
        ASSERT_EQ(steep, expected) << round;
        ASSERT_GT(steep.size(), count / 8);
        for (std::size_t i = 0; i < count; ++i)
            if (tree.is_leaf(elements[i]) && i % 5 == 0) tree.split(elements[i], Cut::both), steps.remove(i);
        add_leaves(size);
    }
}

TEST(CornerSteps, AreFoundAgainAsSoonAsTheChangesMayHaveMadeThemTooLarge) {
    const auto half = [&](double x) { return Patch{{x, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram}; };
    CornerSteps steps(1e-6);
    for (int k = 0; k < 3; ++k) steps.add(RegionId(0), half(k), k != 2);
    std::array<double, 3> values{};
    std::size_t calls = 0;
    const auto value = [&](std::size_t i) { return ++calls, Spectrum(values[i]); };
    const auto grow = [&](double by) {
        values[2] += by;
        return steps.steeper_than(1, by, value);
    };
    EXPECT_TRUE(grow(0).empty());
    EXPECT_GT(calls, 0u);
    calls = 0;
    EXPECT_TRUE(grow(0.4).empty());
    EXPECT_EQ(calls, 0u);  // two corners cannot have moved apart by more than 0.8
    EXPECT_TRUE(grow(1.5).empty());
    EXPECT_GT(calls, 0u);
    // The corner between the elements 1 and 2 has their mean value, here 1.05 from that of element 1. Element 2 is as
    // steep but was added without being watched.
    EXPECT_EQ(grow(0.2), std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace exitance

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
        steps.average(values);
        const std::size_t size = tree.size(), count = elements.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (!tree.is_leaf(elements[i])) continue;
            ASSERT_EQ(steps.largest_step(i), step_of(anew, elements[i])) << round << " " << i;
            if (i % 5 == 0) tree.split(elements[i], Cut::both), steps.remove(i);
        }
        add_leaves(size);
    }
}

}  // namespace
}  // namespace exitance

#include "exitance/basis/element_polynomials.hpp"

#include <gtest/gtest.h>

#include "support/element_kinds.hpp"

namespace exitance {
namespace {

/// Elements of every kind, and a thin sliver of a cell.
ElementTree four_kinds() {
    ElementTree tree = test::elements_of_every_kind();
    tree.split_by_line(ElementId(3), {{1, 0}, 1e-4});
    return tree;
}

TEST(ElementPolynomials, AreOrthonormalOverTheirPlaces) {
    const ElementTree tree = four_kinds();
    for (ElementId e : tree.leaves()) {
        const std::vector<WeightedPlace> places = element_rule(tree, e, RuleOrder::finer);
        const ElementPolynomials phi(tree, e, places, true);
        for (std::size_t j = 0; j < phi.size(); ++j)
            for (std::size_t k = 0; k <= j; ++k) {
                double product = 0;
                for (const WeightedPlace& p : places) product += p.weight * phi.at(p.uv)[j] * phi.at(p.uv)[k];
                EXPECT_NEAR(product, j == k ? 1 : 0, 1e-10) << e.value << ' ' << j << ' ' << k;
            }
    }
}

TEST(ElementPolynomials, ReproducePolynomialsOfSecondDegree) {
    const ElementTree tree = four_kinds();
    for (ElementId e : tree.leaves()) {
        const std::vector<WeightedPlace> places = element_rule(tree, e, RuleOrder::finer);
        const ElementPolynomials phi(tree, e, places, true);
        const bool square = phi.straight() == 4;
        const auto f = [&](Vec2 p) {
            return 1 + p.x - 2 * p.y + 3 * p.x * p.x - p.x * p.y + (square ? 2 * p.x * p.x * p.y * p.y : 0);
        };
        ElementPolynomials::Values c{};
        for (const WeightedPlace& p : places)
            for (std::size_t k = 0; k < phi.size(); ++k) c[k] += p.weight * f(p.uv) * phi.at(p.uv)[k];
        for (const Vec2 corner : tree.domain(e)) {
            double value = 0;
            for (std::size_t k = 0; k < phi.size(); ++k) value += c[k] * phi.at(corner)[k];
            EXPECT_NEAR(value, f(corner), 1e-9);
        }
    }
}

TEST(ElementPolynomials, OmitPolynomialsThatOnePointCannotDetermine) {
    const ElementTree tree = four_kinds();
    const std::vector<WeightedPlace> middle = {{{0.5, 0.5}, 1}};
    const ElementPolynomials phi(tree, ElementId(0), middle, false);
    EXPECT_EQ(phi.at({0.9, 0.1}), (ElementPolynomials::Values{1}));
}

}  // namespace
}  // namespace exitance

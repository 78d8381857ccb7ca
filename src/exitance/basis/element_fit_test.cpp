#include "exitance/basis/element_fit.hpp"

#include <gtest/gtest.h>

#include "support/element_kinds.hpp"

namespace exitance {
namespace {

Spectrum spectrum(double value) {
    return Spectrum(value);
}

TEST(ElementFit, ReproducesPolynomialsOfItsDegree) {
    const ElementTree tree = test::elements_of_every_kind();
    for (ElementId e : tree.leaves()) {
        const bool bilinear = !tree.is_cell(e) && !tree.patch(e).is_triangle();
        const auto f = [&](Vec2 p) { return 1 + 2 * p.x - 3 * p.y + (bilinear ? 4 * p.x * p.y : 0); };
        for (RuleOrder order : {RuleOrder::nodes, RuleOrder::fine}) {
            const std::vector<WeightedPlace> rule = element_rule(tree, e, order);
            std::vector<Spectrum> values;
            for (const WeightedPlace& p : rule) values.push_back(spectrum(f(p.uv)));
            const ElementFit fit(tree, e, rule, values);
            for (const Vec2 p : {Vec2{0, 0}, Vec2{0.3, 0.9}, Vec2{1, 0.2}}) EXPECT_NEAR(fit.at(p)[0], f(p), 1e-11);
        }
    }
}

TEST(ElementFit, WeightsOfARuleSumToOneAndItsPointsAreInside) {
    const ElementTree tree = test::elements_of_every_kind();
    for (ElementId e : tree.leaves())
        for (RuleOrder order : {RuleOrder::nodes, RuleOrder::fine}) {
            double sum = 0;
            const std::vector<Vec2> domain = tree.domain(e);
            for (const WeightedPlace& p : element_rule(tree, e, order)) {
                sum += p.weight;
                for (std::size_t i = 0; i < domain.size(); ++i)
                    EXPECT_GT(cross(domain[(i + 1) % domain.size()] - domain[i], p.uv - domain[i]), 0);
            }
            EXPECT_NEAR(sum, 1, 1e-14);
        }
}

TEST(ElementFit, FineRulesIntegrateTheirDegree) {
    const ElementTree tree = test::elements_of_every_kind();
    // Squares: u^4 v^4 has the mean 1/25; triangles: u^3 v^2 has the mean 2 x 3! 2! / 7! = 1/210.
    double square = 0, triangle = 0;
    for (const WeightedPlace& p : element_rule(tree, ElementId(0), RuleOrder::fine))
        square += p.weight * std::pow(p.uv.x, 4) * std::pow(p.uv.y, 4);
    for (const WeightedPlace& p : element_rule(tree, ElementId(1), RuleOrder::fine))
        triangle += p.weight * std::pow(p.uv.x, 3) * std::pow(p.uv.y, 2);
    EXPECT_NEAR(square, 1.0 / 25, 1e-15);
    EXPECT_NEAR(triangle, 1.0 / 210, 1e-15);
}

}  // namespace
}  // namespace exitance

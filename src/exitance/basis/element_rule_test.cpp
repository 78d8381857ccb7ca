#include "exitance/basis/element_rule.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "exitance/base/quadrature.hpp"
#include "support/element_kinds.hpp"

namespace exitance {
namespace {

/// Integrates a polynomial over a triangle by a rule of degree 8, which is exact for the polynomials of this test.
double over_triangle(Vec2 a, Vec2 b, Vec2 c, const std::function<double(Vec2)>& f) {
    double sum = 0;
    const Vec2 ab = b - a, ac = c - a;
    for (const PlanarNode& k : triangle_rule(8)) sum += k.weight * f(a + k.at.x * ab + k.at.y * ac);
    return 0.5 * cross(ab, ac) * sum;
}

// A polynomial of degree 3, composed with the bilinear map onto a quadrangle and times its area element, has degree 7.
TEST(ElementRule, FinerRuleIsExactForPolynomialsOfDegreeThree) {
    ElementTree tree = test::elements_of_every_kind();
    tree.split_by_line(ElementId(1), {{1, 0.3}, 0.4});
    for (ElementId e : tree.leaves()) {
        const std::vector<Vec2> domain = tree.domain(e);
        if (domain.size() > 4) continue;
        for (int p = 0; p <= 3; ++p)
            for (int q = 0; p + q <= 3; ++q) {
                const auto f = [&](Vec2 x) { return std::pow(x.x, p) * std::pow(x.y, q); };
                double exact = 0, area = 0;
                for (std::size_t k = 2; k < domain.size(); ++k) {
                    exact += over_triangle(domain[0], domain[k - 1], domain[k], f);
                    area += over_triangle(domain[0], domain[k - 1], domain[k], [](Vec2) { return 1.0; });
                }
                double mean = 0;
                for (const WeightedPlace& place : element_rule(tree, e, RuleOrder::finer)) {
                    EXPECT_GT(place.weight, 0);
                    mean += place.weight * f(place.uv);
                }
                EXPECT_NEAR(mean, exact / area, 1e-13) << domain.size() << " corners: " << p << ' ' << q;
            }
    }
}

}  // namespace
}  // namespace exitance

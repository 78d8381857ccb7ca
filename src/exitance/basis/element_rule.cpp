#include "exitance/basis/element_rule.hpp"

#include <span>
#include <utility>

#include "exitance/geometry/quadrature.hpp"

namespace exitance {
namespace {

std::vector<WeightedPlace> places_of(std::span<const PlanarNode> rule) {
    std::vector<WeightedPlace> out;
    for (const PlanarNode& node : rule) out.push_back({node.at, node.weight});
    return out;
}

/// On the way from the centre to each corner, where Gauss's nodes of a parallelogram would stand; or the fan of
/// triangles around the centre, each with the rule of three places.
std::vector<WeightedPlace> cell_rule(const std::vector<Vec2>& domain, Vec2 centre, RuleOrder order) {
    const std::size_t n = domain.size();
    std::vector<WeightedPlace> rule;
    double whole = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 before = domain[(i + n - 1) % n] - centre, a = domain[i] - centre, b = domain[(i + 1) % n] - centre;
        const double area = 0.5 * cross(a, b);
        whole += area;
        if (order == RuleOrder::nodes) {
            const double reach = n == 3 ? 0.5 : 1 / std::sqrt(3.0);
            rule.push_back({centre + reach * a, 0.5 * (area + 0.5 * cross(before, a))});
        } else {
            for (const auto& [p, q] : {std::pair{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}})
                rule.push_back({centre + p * a + q * b, area / 3});
        }
    }
    for (WeightedPlace& place : rule) place.weight /= whole;
    return rule;
}

}  // namespace

std::vector<WeightedPlace> element_rule(const ElementTree& tree, ElementId e, RuleOrder order) {
    if (tree.is_cell(e)) return cell_rule(tree.domain(e), tree.centre(e), order);
    const bool triangle = tree.patch(e).is_triangle();
    switch (order) {
        case RuleOrder::nodes:
            return places_of(triangle ? triangle_rule(2) : square_rule(2));
        case RuleOrder::fine:
            return places_of(triangle ? triangle_rule(5) : square_rule(3));
        case RuleOrder::finer:
            break;
    }
    return places_of(triangle ? triangle_rule(8) : scattered_square_rule());
}

}  // namespace exitance

#include "exitance/basis/element_rule.hpp"

#include <span>
#include <utility>

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

std::vector<WeightedPlace> places_of(std::span<const PlanarNode> rule) {
    std::vector<WeightedPlace> out;
    for (const PlanarNode& node : rule) out.push_back({node.at, node.weight});
    return out;
}

/// Maps the rule of the unit square to a convex quadrangle by the bilinear map of its corners, or the rule of the
/// triangle to a triangle. Weights include the area element of the map.
std::vector<WeightedPlace> mapped_rule(const std::vector<Vec2>& domain) {
    const Vec2 o = domain[0], a = domain[1] - o, b = domain.back() - o;
    std::vector<WeightedPlace> rule;
    if (domain.size() == 3) {
        for (const auto& [at, weight] : triangle_rule(8)) rule.push_back({o + at.x * a + at.y * b, weight});
        return rule;
    }
    const Vec2 bend = domain[2] - o - a - b;
    double whole = 0;
    for (const auto& [at, weight] : scattered_square_rule()) {
        const double area = weight * cross(a + at.y * bend, b + at.x * bend);
        rule.push_back({o + at.x * a + at.y * b + at.x * at.y * bend, area});
        whole += area;
    }
    for (WeightedPlace& place : rule) place.weight /= whole;
    return rule;
}

/// `nodes`: one point on the line from the centre to each corner, at the relative distance of the Gauss nodes of a
/// parallelogram. Other orders: triangles between the centre and each side, each with the rule of three points.
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
    if (tree.is_cell(e)) {
        const std::vector<Vec2> domain = tree.domain(e);
        if (order == RuleOrder::finer && domain.size() <= 4) return mapped_rule(domain);
        return cell_rule(domain, tree.centre(e), order);
    }
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

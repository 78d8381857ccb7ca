#include "exitance/links/error/check_points.hpp"

#include "exitance/base/quadrature.hpp"

namespace exitance {
namespace {

std::vector<Vec2> gauss_points(Patch::Shape shape) {
    std::vector<Vec2> out;
    for (const PlanarNode& node : shape == Patch::Shape::triangle ? triangle_rule(2) : square_rule(2))
        out.push_back(node.at);
    return out;
}

/// Points at which the interpolation of a basis is checked. There the lowest polynomial that interpolation misses (one
/// degree above the basis and zero at its nodes) is close to its RMS value over the element.
std::vector<Vec2> points_between_nodes(Patch::Shape shape, int order) {
    if (shape == Patch::Shape::triangle) {
        // Order 2: derived from that polynomial, like all points below.
        if (order == 2) return {{1.0 / 3, 1.0 / 3}, {0.5, 0.08}, {0.08, 0.5}, {0.42, 0.42}};
        // Order 3: derived from the nodes of the rule that is exact for linear functions.
        return {{1.0 / 3, 1.0 / 3}, {0.12, 0.12}, {0.76, 0.12}, {0.12, 0.76}};
    }
    // Order 2: derived from that polynomial, too.
    if (order == 2) return {{0.5, 0.5}, {0.5, 0.08}, {0.92, 0.5}, {0.5, 0.92}, {0.08, 0.5}};
    constexpr double g = 0.26;  // distance from the centre; derived from that polynomial, for order 3
    return {{0.5, 0.5}, {0.5 - g, 0.5 - g}, {0.5 + g, 0.5 - g}, {0.5 - g, 0.5 + g}, {0.5 + g, 0.5 + g}};
}

}  // namespace

CheckPoints::CheckPoints(const NodalBasis& basis)
    : nodes_(basis.count()),
      parallelogram_(make_points(basis, Patch::Shape::parallelogram)),
      triangle_(make_points(basis, Patch::Shape::triangle)) {}

CheckPoints::Points CheckPoints::make_points(const NodalBasis& basis, Patch::Shape shape) {
    const std::size_t n = basis.count();
    Points out{.at = n == 1 ? gauss_points(shape) : points_between_nodes(shape, basis.order()), .factors = {}};
    out.factors.resize(out.at.size() * n);
    for (std::size_t i = 0; i < out.at.size(); ++i)
        basis.interpolate(shape, out.at[i], std::span(out.factors).subspan(i * n, n));
    return out;
}

}  // namespace exitance

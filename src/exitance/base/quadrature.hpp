#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Nodes and weights of a rule on [0, 1]: Int_0^1 f = sum_k weights[k] f(nodes[k]). Nodes ascend, weights sum to 1.
struct LineRule {
    std::span<const double> nodes, weights;
    std::size_t size() const { return nodes.size(); }
};

/// Returns the Gauss-Legendre rule of n points, 1 <= n <= 32, exact for polynomials of degree 2n - 1. Nodes are the
/// roots of the Legendre polynomial, to the last digits (Newton's iteration from Tricomi's estimate). All rules are
/// computed at the first call.
LineRule gauss_legendre(int n);

inline constexpr int largest_gauss_rule = 32;

/// A point of a quadrature rule over a reference shape, and its weight.
struct PlanarNode {
    Vec2 at;
    double weight = 0;
};

/// Returns n x n Gauss points of the unit square, weights summing to 1, 1 <= n <= 32. Exact to degree 2n - 1 in each
/// direction.
std::span<const PlanarNode> square_rule(int n);

/// Returns 16 points of the unit square, weights summing to 1, exact to total degree 8; no rule with fewer points is
/// known [Wissmann86]. No two points share a row or column. They therefore detect functions that are zero at all 4 x 4
/// Gauss points (the Legendre polynomial of degree 4), and shadows narrower than the distance of two Gauss rows.
std::span<const PlanarNode> scattered_square_rule();

/// Returns a rule for the triangle {u, v >= 0, u + v <= 1}, exact to total degree `degree`, 0 to 30; weights are
/// positive and sum to 1. Symmetric rules of 1, 3, 6, 7 and 16 points up to degree 8 ([Dunavant85], [Radon48]),
/// collapsed Gauss above.
std::span<const PlanarNode> triangle_rule(int degree);

inline constexpr int largest_triangle_degree = 30;

}  // namespace exitance

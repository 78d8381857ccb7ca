#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Nodes and weights on [0, 1]: Int_0^1 f = sum_k weights[k] f(nodes[k]). Nodes ascend, weights sum to 1.
struct LineRule {
    std::span<const double> nodes, weights;
    std::size_t size() const { return nodes.size(); }
};

/// Gauss-Legendre rule of n points, 1 <= n <= 32, exact for polynomials of degree 2n - 1. Nodes are the roots of the
/// Legendre polynomial by Newton's iteration from Tricomi's estimate, right to the last digits. Made once.
LineRule gauss_legendre(int n);

inline constexpr int largest_gauss_rule = 32;

/// A point of a rule over a reference shape, and its share of the shape's area.
struct PlanarNode {
    Vec2 at;
    double weight = 0;
};

/// n x n Gauss points of the unit square, weights summing to 1, 1 <= n <= 32. Exact to degree 2n - 1 in each direction.
std::span<const PlanarNode> square_rule(int n);

/// 16 points of the unit square, weights summing to 1, exact to total degree 8; none of fewer is known [Wissmann86]. No
/// two of them stand in line, so that they see what 4 x 4 Gauss points are blind to: Legendre's polynomial of degree 4,
/// which vanishes at all of those, or a shadow no wider than the space between two rows.
std::span<const PlanarNode> scattered_square_rule();

/// A rule for the triangle {u, v >= 0, u + v <= 1}, weights summing to 1, all positive, exact to total degree `degree`,
/// 0 to 30. Symmetric rules of 1, 3, 6, 7 and 16 points to degree 8 ([Dunavant85], [Radon48]), collapsed Gauss above.
std::span<const PlanarNode> triangle_rule(int degree);

inline constexpr int largest_triangle_degree = 30;

}  // namespace exitance

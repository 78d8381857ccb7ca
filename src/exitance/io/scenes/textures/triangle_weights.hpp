#pragma once

#include <array>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Barycentric coordinates in a triangle in space.
struct TriangleWeights {
    explicit TriangleWeights(const std::array<Point, 3>& c)
        : corner(c), n(cross(c[1] - c[0], c[2] - c[0])), area(squared_norm(n)) {}

    /// Weights of the corners for a point of the triangle's plane.
    std::array<double, 3> at(const Point& p) const {
        const double b = dot(cross(p - corner[0], corner[2] - corner[0]), n) / area;
        const double c = dot(cross(corner[1] - corner[0], p - corner[0]), n) / area;
        return {1 - b - c, b, c};
    }

    std::array<Point, 3> corner;
    Vec3 n;
    double area;  ///< (2 x area)^2, m^4
};

}  // namespace exitance

#pragma once

#include <array>
#include <cstddef>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Clough-Tocher element: a function on a triangle, defined by its values and gradients at the corners and its normal
/// slopes at the middles of the edges. It consists of three cubic polynomials, on the sub-triangles between an edge and
/// the centroid, that join with a continuous tangent plane. It reproduces cubic polynomials. Two triangles with a
/// common edge join with a continuous tangent plane, too, if they share the data on it. Source: [CloughTocher65]; as
/// Bezier polynomials: [Farin86].
struct CloughTocher {
    /// The data that define the function. Edge i leads from corner i to corner i + 1, opposite corner i + 2.
    struct Data {
        std::array<double, 3> value;  ///< Value at corner i.
        /// Gradient at corner i times the vector to corner i + 1, and to corner i + 2.
        std::array<std::array<double, 2>, 3> to_next;
        std::array<double, 3> across;  ///< Gradient at the middle of edge i times the vector to the opposite corner.
    };
    explicit CloughTocher(const Data& data);

    /// Value at barycentric coordinates L.
    double at(const std::array<double, 3>& L) const;
    /// Mean over the triangle.
    double mean() const;

  private:
    // Bezier ordinates; S is the centroid.
    std::array<double, 3> corner_;
    std::array<std::array<double, 2>, 3> edge_;  ///< On edge i, next to corner i, and next to corner i + 1.
    std::array<double, 3> spoke_,
        hub_;                     ///< On the line from corner i to S: next to the corner (spoke), next to S (hub).
    std::array<double, 3> wing_;  ///< Ordinate in the middle of the sub-triangle at edge i.
    double centre_;
};

/// The vector from an edge's middle to the opposite corner, as a share `along` of the edge plus a perpendicular
/// `height` (metres).
struct EdgeFrame {
    double along = 0, height = 0;

    EdgeFrame(const Point& a, const Point& b, const Point& across);
};

/// Gradient at the middle of edge i times the vector from corner i to the next; it follows from the data at the edge's
/// ends.
double slope_along(const CloughTocher::Data& data, std::size_t edge);

}  // namespace exitance

#pragma once

#include <array>
#include <cstddef>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Clough and Tocher's element: a function on a triangle by its values and slopes at the corners and one slope at the
/// middle of every edge. Three cubic polynomials, on the triangle's parts between its edges and its centroid, that join
/// with one tangent plane. Cubic polynomials are reproduced; two triangles that share an edge, its ends' values and
/// slopes and its middle's slope join with one tangent plane, too. Source: [CloughTocher65]; as Bezier polynomials,
/// [Farin86].
struct CloughTocher {
    /// What the function is given by, of edges i from corner i to corner i + 1 across from corner i + 2.
    struct Data {
        std::array<double, 3> value;                   ///< At corner i.
        std::array<std::array<double, 2>, 3> to_next;  ///< Slope at corner i times the way to corner i + 1, i + 2.
        std::array<double, 3> across;                  ///< Slope at the middle of edge i times the way to the corner
                                                       ///< across.
    };
    explicit CloughTocher(const Data& data);

    /// At barycentric coordinates.
    double at(const std::array<double, 3>& L) const;
    /// Over the triangle.
    double mean() const;

  private:
    // Bezier ordinates; S is the centroid.
    std::array<double, 3> corner_;
    std::array<std::array<double, 2>, 3> edge_;  ///< On edge i, next to corner i, i + 1.
    std::array<double, 3> spoke_, hub_;          ///< On the line from corner i to S, next to the corner, to S.
    std::array<double, 3> wing_;                 ///< In the midst of the part beside edge i.
    double centre_;
};

/// The way from an edge's middle to the corner across: so much of the edge and so far at a right angle to it.
struct EdgeFrame {
    double along = 0, height = 0;

    EdgeFrame(const Point& a, const Point& b, const Point& across);
};

/// Slope along edge i at its middle times the way from corner i to the next: it follows from the edge's ends.
double slope_along(const CloughTocher::Data& data, std::size_t edge);

}  // namespace exitance

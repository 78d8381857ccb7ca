#pragma once

#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"

namespace exitance {

/// Check points of a receiver between its nodes, the centre first. At these points, a polynomial of the basis and one
/// of the next degree differ by about as much as in the mean. For constants: Gauss points.
class CheckPoints {
  public:
    explicit CheckPoints(const NodalBasis& basis);

    /// Returns the check points, at most five, in coordinates of the shape.
    std::span<const Vec2> at(Patch::Shape shape) const { return points(shape).at; }
    /// Weights of the basis's nodes in the interpolated value at check point i.
    std::span<const double> factors(Patch::Shape shape, std::size_t i) const {
        return std::span(points(shape).factors).subspan(i * nodes_, nodes_);
    }

  private:
    struct Points {
        std::vector<Vec2> at;
        std::vector<double> factors;  ///< Weights of the nodes at each check point, one row per point.
    };
    static Points make_points(const NodalBasis& basis, Patch::Shape shape);
    const Points& points(Patch::Shape shape) const {
        return shape == Patch::Shape::triangle ? triangle_ : parallelogram_;
    }

    std::size_t nodes_;
    Points parallelogram_, triangle_;
};

}  // namespace exitance

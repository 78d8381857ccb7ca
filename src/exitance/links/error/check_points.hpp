#pragma once

#include <span>
#include <vector>

#include "exitance/basis/nodal_basis.hpp"

namespace exitance {

/// Points of a receiver between its nodes, the middle first, at which a polynomial of the basis and one of a degree
/// more differ by about as much as in the mean; of constants, Gauss's points.
class CheckPoints {
  public:
    explicit CheckPoints(const NodalBasis& basis);

    /// At most five, in coordinates of the shape.
    std::span<const Vec2> at(Patch::Shape shape) const { return points(shape).at; }
    /// Factors of the basis's numbers in its function at check point i.
    std::span<const double> factors(Patch::Shape shape, std::size_t i) const {
        return std::span(points(shape).factors).subspan(i * nodes_, nodes_);
    }

  private:
    struct Points {
        std::vector<Vec2> at;
        std::vector<double> factors;  ///< A row of nodes a point.
    };
    static Points make_points(const NodalBasis& basis, Patch::Shape shape);
    const Points& points(Patch::Shape shape) const {
        return shape == Patch::Shape::triangle ? triangle_ : parallelogram_;
    }

    std::size_t nodes_;
    Points parallelogram_, triangle_;
};

}  // namespace exitance

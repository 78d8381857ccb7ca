#pragma once

#include <string>
#include <vector>

#include "exitance/measure/measuring_grid.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

constexpr double one_plane = 1e-3;  ///< Distance below which faces are in one plane, metres.

/// A polygon with holes: a region, or one face of it.
struct FloorShape {
    RegionId region;
    std::vector<std::vector<Point>> loops;
    Plane plane;
    double area = 0;  ///< m^2
    Box box;

    bool holds(const Point& p) const;
};

/// Coplanar shapes that touch each other.
struct Floor {
    std::vector<FloorShape> shapes;
    double area = 0;  ///< m^2

    /// Index of the shape that contains a point of the floor's plane; the number of shapes if none does.
    std::size_t shape_at(const Point& p) const;
    bool holds(const Point& p) const { return shape_at(p) < shapes.size(); }
};

/// True if a face or region of this normal can be stood on.
bool points_up(const Normal& n);

FloorShape floor_shape(const Region& region, RegionId id);

/// Faces of a group: whole regions if all of their faces are in it, else single faces. If some of them point up, the
/// others are left out.
std::vector<FloorShape> shapes_of_group(const Scene& scene, const std::string& name);

/// Groups shapes that are in one plane and touch each other directly or indirectly; the largest group first.
std::vector<Floor> join_shapes(std::vector<FloorShape> shapes);

/// Bounding rectangle of a floor, aligned with its longest edge. Its u axis is the one of the four side directions that
/// is closest to +x.
MeasuringPlane rectangle_about(const Floor& floor);

}  // namespace exitance

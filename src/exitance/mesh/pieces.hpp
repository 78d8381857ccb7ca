#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// One of the parallelograms and triangles that tile a region: the root of an element tree.
struct Piece {
    RegionId region;
    Patch patch;  ///< Faces the same way as the region.
};

/// Tiles a polygon with few, well-shaped parallelograms and triangles:
///  - a triangle or a parallelogram is one piece;
///  - if all corners are right angles: rectangles, cut along lines of minimal total length;
///  - a trapezoid becomes a parallelogram and a triangle, unless the triangle would be a sliver;
///  - a parallelogram on three consecutive edges is cut off;
///  - anything else is triangulated (Delaunay, which avoids slivers), and pairs of triangles that form a parallelogram
///  are joined.
/// There may be T-vertices between pieces. The areas sum to the polygon's.
/// loops  outer loops counter-clockwise seen from the front, holes clockwise, metres
std::vector<Patch> tile(std::span<const std::vector<Point>> loops, const Normal& n);

/// Tiles all regions of a scene, in the order of their ids. O(corners), except for large concave regions. Parallel.
std::vector<Piece> cut_into_pieces(const Scene& scene);

}  // namespace exitance

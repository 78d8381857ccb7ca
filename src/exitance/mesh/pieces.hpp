#pragma once

#include <vector>

#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// One of the parallelograms and triangles that tile a region: the root of an element tree.
struct Piece {
    RegionId region;
    Patch patch;  ///< Its front is the region's.
};

/// Tiles a polygon by parallelograms and triangles, as few and as well shaped as is simple:
///  - a triangle or a parallelogram is one piece;
///  - where all corners are right angles, rectangles, cut along the shortest lines that do it;
///  - a trapezoid is a parallelogram and a triangle, unless that triangle were a sliver;
///  - a parallelogram on three edges in a row is taken off;
///  - anything else is triangulated (Delaunay, so that slivers are avoided), pairs that form a parallelogram joined.
/// Neighbouring pieces may meet in T-vertices. Areas sum to the polygon's.
/// loops  outer loops counter-clockwise seen from the front, holes clockwise, metres
std::vector<Patch> tile(std::span<const std::vector<Point>> loops, const Normal& n);

/// All regions of a scene, tiled, in the order of their ids. O(corners) but for large concave regions; on all threads.
std::vector<Piece> cut_into_pieces(const Scene& scene);

}  // namespace exitance

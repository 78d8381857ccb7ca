#pragma once

#include <span>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/scene/scene.hpp"
#include "exitance/view_factors/convex_parts.hpp"

namespace exitance {

/// One face of a scene as a receiver and source of view factors.
struct ViewFace {
    std::span<const Point> outline;
    Plane plane;
    double area = 0;  ///< m^2
    Box box;
    ConvexParts pieces;    ///< With at most 12 corners each.
    double diameter = 0;   ///< Diagonal of its box, metres.
    bool is_quad = false;  ///< Convex, with three or four corners.
    double thickness = 0;  ///< Limit on the distance of stacked faces, metres, see face_each_other().
};

/// Returns a scene's faces in the order of its file. The scene must outlive them.
std::vector<ViewFace> make_view_faces(const Scene& scene);

/// Returns true if each face is at least partly in front of the other; points within `slack` metres of a plane are in
/// it. Sets `cut` if part of a face is behind the other's plane. Stacked faces, like a board and the table below it, do
/// not face each other even if rounding in files has moved them apart: rays from below the other face start covered
/// (Occluders::is_covered).
bool face_each_other(const ViewFace& a, const ViewFace& b, double slack, bool& cut);

/// Distance between the faces' bounding boxes, metres: a lower bound on the distance between the faces.
double box_distance(const ViewFace& a, const ViewFace& b);

}  // namespace exitance

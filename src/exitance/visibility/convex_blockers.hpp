#pragma once

#include <cstdint>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// A convex occluder: either a sheet (one face that blocks light from both sides) or a closed solid whose faces point
/// outwards. From any point, a solid hides one pyramid, that over its silhouette; treated as separate faces it would
/// need one pyramid per face.
struct ConvexBlocker {
    struct Edge {
        std::uint32_t a = 0, b = 0;              ///< Corners, in the direction of the border of face `left`.
        std::int32_t left = 0, right = no_face;  ///< The two faces that share the edge.
    };
    static constexpr std::int32_t no_face = -1;
    static constexpr std::size_t max_faces = 32;

    std::vector<Point> points;
    std::vector<Plane> faces;
    std::vector<std::vector<std::uint32_t>> loops;  ///< Border of each face, counter-clockwise seen from its front.
    std::vector<Edge> edges;

    bool is_solid() const { return faces.size() > 1; }
};

/// Makes a sheet from one convex outline (metres).
ConvexBlocker make_sheet(std::span<const Point> outline, const Plane& plane);

/// Clips a closed body by a plane.
/// plane  its front is kept; the cut is closed by a new face in it
/// slack  metres: points nearer to the plane than this are in it
/// part  receives the clipped body; no points if nothing of the body is in front
/// Returns false if rounding leaves no closed body, or if it has too many faces; `part` is then unusable.
bool clip_body(const ConvexBlocker& body, const Plane& plane, double slack, ConvexBlocker& part);

/// The closed convex bodies of a scene, first in make_convex_blockers(). O(n log n).
/// slack  metres: points nearer to a plane than this are in it
std::vector<ConvexBlocker> make_solid_blockers(const Occluders& occluders, double slack);

/// Everything in a scene that can block light: closed convex bodies first, then the pieces of all other regions as
/// sheets. Sheets with the whole scene on one side (the walls of a convex room) block nothing and are omitted. O(n log
/// n).
/// slack  metres: points nearer to a plane than this are in it
std::vector<ConvexBlocker> make_convex_blockers(const Occluders& occluders, double slack);

/// Bit mask of the faces of a blocker that have a polygon entirely in front of them. For a sheet, bit 1 is set if the
/// polygon is entirely behind it. The blocker hides nothing between two polygons that share a bit: the plane of that
/// face separates it from both.
std::uint32_t sides(const ConvexBlocker& blocker, std::span<const Point> polygon, double slack);

}  // namespace exitance

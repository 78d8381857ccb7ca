#pragma once

#include <cstdint>
#include <vector>

#include "exitance/base/polygon.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// A convex thing that blocks light: a sheet (one face, seen and blocking from both sides) or a closed solid with its
/// faces outwards. A solid is worth finding: as seen from a point it hides what lies in the one pyramid over its
/// silhouette, where its faces by themselves would hide as many pyramids as there are faces.
struct ConvexBlocker {
    struct Edge {
        std::uint32_t a = 0, b = 0;              ///< Corners, along the border of face `left`.
        std::int32_t left = 0, right = no_face;  ///< The faces beside it.
    };
    static constexpr std::int32_t no_face = -1;
    static constexpr std::size_t most_faces = 32;

    std::vector<Point> points;
    std::vector<Plane> faces;
    std::vector<std::vector<std::uint32_t>> loops;  ///< Border of each face, counter-clockwise seen from its front.
    std::vector<Edge> edges;

    bool is_solid() const { return faces.size() > 1; }
};

/// A sheet of its own: one convex outline.
ConvexBlocker make_sheet(std::span<const Point> outline, const Plane& plane);

/// The part of a closed body in front of a plane, closed by a face in that plane; nothing (no points) when there is
/// none. What lies nearer to the plane than `slack` (metres) lies in it. False, and `part` of no use, when rounding
/// leaves no closed body, or one of too many faces.
bool clip_body(const ConvexBlocker& body, const Plane& plane, double slack, ConvexBlocker& part);

/// What can block light in a scene: closed convex bodies, then the pieces of everything else. Sheets that have the
/// whole scene on one side (the walls of a convex room) can block nothing and are left out. O(n log n).
/// slack  metres: points nearer to a plane than this lie in it
std::vector<ConvexBlocker> make_convex_blockers(const Occluders& occluders, double slack);

/// Which faces of a blocker have a polygon wholly in front of them, a bit each; of a sheet the second bit says wholly
/// behind. Two polygons that share a bit see each other past the blocker: its plane keeps it apart from both.
std::uint32_t sides(const ConvexBlocker& blocker, std::span<const Point> polygon, double slack);

}  // namespace exitance

#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Returns the solid angle of a triangle from the origin, 0 or more. Source: [VanOosterom83].
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// A planar triangle as seen from an eye in the origin.
struct ViewTriangle {
    std::array<Vec3, 3> corners;

    double solid_angle() const { return exitance::solid_angle(corners[0], corners[1], corners[2]); }
    /// Returns the direction to its middle as seen from the eye, unit vector.
    Normal middle() const {
        return normalized(normalized(corners[0]) + normalized(corners[1]) + normalized(corners[2]));
    }
    /// Returns the largest angle between two corners, radians.
    double extent() const;
    /// Returns its four parts. The edges are cut in the middle as seen from the eye.
    std::array<ViewTriangle, 4> quarters() const;
};

/// Divides a convex polygon, given by its corners from the eye, into triangles of at most this extent, and appends them
/// to `out`. Triangles without area are omitted.
void add_view_triangles(std::span<const Vec3> polygon, double max_extent, std::vector<ViewTriangle>& out);

/// Returns triangles of at most this extent that cover the visible part of each piece, one list per piece.
std::vector<std::vector<ViewTriangle>> visible_triangles(const Occluders& occluders, const SurfacePoint& eye,
                                                         std::span<const PieceId> pieces, double max_extent);

}  // namespace exitance

#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// Affine map of 3D points: a 3 x 4 matrix.
struct Affine {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Images of the axes.
    Vec3 origin;                              ///< Image of the origin.

    Vec3 vector(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
    Point point(const Point& p) const { return origin + vector(p); }
    /// The map that applies `o` first, then this one.
    Affine operator*(const Affine& o) const { return {vector(o.x), vector(o.y), vector(o.z), point(o.origin)}; }
    double determinant() const { return dot(x, cross(y, z)); }
};

}  // namespace exitance

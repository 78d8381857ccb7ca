#pragma once

#include "exitance/base/vec.hpp"

namespace exitance {

/// A matrix of three rows and four columns: points are turned, scaled and moved.
struct Affine {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< Where the axes go,
    Vec3 origin;                              ///< and the origin.

    Vec3 vector(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
    Point point(const Point& p) const { return origin + vector(p); }
    /// First o, then this.
    Affine operator*(const Affine& o) const { return {vector(o.x), vector(o.y), vector(o.z), point(o.origin)}; }
    double determinant() const { return dot(x, cross(y, z)); }
};

}  // namespace exitance

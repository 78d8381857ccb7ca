#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// A place of a convex polygon of that area (m^2) with uniform density, from two numbers in [0, 1).
Point uniform_on(std::span<const Point> corners, double area, double s, double t);

/// Places of a convex polygon for rays from a point x to it. Seen from afar they are uniform in area. Where one part of
/// it is nearer to x than another by half, light comes from the near part, which few such places are on: there they
/// are uniform in solid angle [Arvo95].
class SeenPolygon {
  public:
    /// `corners` must outlive it. n: the polygon's normal, of length 1, area: m^2.
    SeenPolygon(std::span<const Point> corners, const Normal& n, double area, const Point& x);

    Point at(double s, double t) const;
    /// cos cos' / r^2 of a place in the direction d from x, n the receiver's normal, over the density of such places
    /// but for a factor that is the same for all; 0 beneath either horizon.
    double weight(const Vec3& d, const Normal& receiver) const;

  private:
    /// A part of what is seen: unit vectors to its corners, the angle at the first, and the solid angle, sr.
    struct Triangle {
        Vec3 a, b, c;
        double angle, sine, cosine, solid_angle;
    };
    Vec3 direction(double s, double t) const;

    std::span<const Point> corners_;
    Normal n_;
    double area_;
    Point x_;
    std::vector<Triangle> triangles_;  ///< Empty: uniform in area.
    double solid_angle_ = 0;           ///< Of all triangles.
};

}  // namespace exitance

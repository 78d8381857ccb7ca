#pragma once

#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Returns a point of a convex polygon with the given area (m^2), uniformly distributed, from two numbers in [0, 1).
Point uniform_on(std::span<const Point> corners, double area, double s, double t);

/// Samples points of a convex polygon for rays from a point x. For a distant polygon they are uniform in area. If the
/// farthest point of the polygon is 1.5 times as far away as the nearest, most light comes from the near part, where
/// area sampling puts few points; then they are uniform in solid angle [Arvo95].
class SeenPolygon {
  public:
    /// corners  must outlive it
    /// n        unit normal of the polygon
    /// area     m^2
    SeenPolygon(std::span<const Point> corners, const Normal& n, double area, const Point& x);

    Point at(double s, double t) const;
    /// Returns cos cos' / r^2 over the sampling density for a point in direction d from x, up to a constant factor; 0
    /// below either horizon. `receiver` is the normal at x.
    double weight(const Vec3& d, const Normal& receiver) const;
    /// Returns the factor by which the mean of weight() is the integral of the cosine over the visible solid angle.
    double measure() const { return triangles_.empty() ? area_ : solid_angle_; }

  private:
    /// Spherical triangle of the visible polygon: unit vectors to its corners, the angle at the first, and the solid
    /// angle, sr.
    struct Triangle {
        Vec3 a, b, c;
        double angle, sine, cosine, solid_angle;
    };
    Vec3 direction(double s, double t) const;
    Point uniform_in_area(double s, double t) const;

    std::span<const Point> corners_;
    Normal n_;
    double area_;
    Point x_;
    std::vector<Triangle> triangles_;     ///< Triangles of the solid angle; empty: samples are uniform in area.
    std::vector<double> area_before_{0};  ///< Sums of the areas of the fan's triangles, m^2, if uniform in area.
    double solid_angle_ = 0;              ///< Sum over the triangles, sr.
};

}  // namespace exitance

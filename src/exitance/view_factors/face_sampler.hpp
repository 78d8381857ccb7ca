#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "exitance/base/limits.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Maps the unit square to points of a face, uniform in area.
class FaceSampler {
  public:
    FaceSampler(const Scene& scene, SurfaceId s);

    /// Returns a point of the face, metres, for u and v in [0, 1).
    Point operator()(double u, double v) const {
        const double wanted = u * area_;
        std::size_t k = 0;
        double before = 0;
        while (k + 1 < triangles_.size() && triangles_[k].area_up_to <= wanted) before = triangles_[k++].area_up_to;
        const Triangle& t = triangles_[k];
        const double share = std::clamp((wanted - before) / std::max(t.area_up_to - before, min_divisor), 0.0, 1.0);
        const double root = std::sqrt(share);
        return t.o + (root * (1 - v)) * t.a + (root * v) * t.b;
    }
    double area() const { return area_; }  ///< m^2
    const Normal& normal() const { return normal_; }
    const Box& box() const { return box_; }

  private:
    struct Triangle {
        Point o;
        Vec3 a, b;
        double area_up_to;  ///< Sum of the areas up to and including this triangle, m^2.
    };
    Normal normal_;
    std::vector<Triangle> triangles_;
    double area_ = 0;
    Box box_;
};

}  // namespace exitance

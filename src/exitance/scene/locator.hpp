#pragma once

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Finds the face that a point lies on. A hierarchy of boxes over the faces; O(log faces) a query, O(n log n) to make.
/// The scene must outlive the locator.
class Locator {
  public:
    explicit Locator(const Scene& scene);

    /// The face that `p` (metres) lies on: within the tolerance of the polygon, and its normal agrees with `n` (of
    /// length 1; dot product above 0.999). Among several it is the nearest; among equally near ones, as on borders and
    /// where faces coincide, a face that holds the foot of p, and then the one of the lowest id. None for a point in
    /// free space. Safe to call from any thread.
    SurfaceId find(const Point& p, const Normal& n) const;

    double tolerance() const { return tolerance_; }  ///< 1e-5 of the scene's size, metres.

  private:
    struct Candidate;

    void look_at(SurfaceId s, const Point& p, const Normal& n, Candidate& best) const;

    const Scene* scene_;
    double tolerance_;
    Bvh tree_;
};

}  // namespace exitance

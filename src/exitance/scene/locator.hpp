#pragma once

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Finds the face on which a point lies, by a bounding volume hierarchy over the faces. O(log faces) per query, O(n log
/// n) to build. The scene must outlive the locator.
class Locator {
  public:
    explicit Locator(const Scene& scene);

    /// Returns the face on which `p` (metres) lies: within the tolerance of the polygon, with a normal that agrees with
    /// `n` (unit vector; dot product above 0.999). Among several it is the nearest. Among equally near ones, as on
    /// borders and on coincident faces, it is a face that contains the projection of p, then the one with the lowest
    /// id. None for a point in free space. Thread-safe.
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

#pragma once

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Faces of planes that have faces looking both ways, as the two sides of a sheet do whose outlines differ: a ray that
/// comes to such a place meets the face that looks towards it, whichever of them a search in single precision finds.
/// The scene must outlive it. O(faces) to make.
class OpposedFaces {
  public:
    /// other_side  of faces, as other_sides_of_surfaces() gives it: planes whose faces all have one are left out
    /// tolerance   metres; planes nearer than this are one
    OpposedFaces(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, double tolerance);

    /// Is this one of those faces?
    bool has(SurfaceId s) const { return is_opposed_.size() > 0 && is_opposed_[s] != 0; }

    /// The face in whose plane and outline `at` lies (metres), within the tolerance, and whose front a ray along
    /// `direction` meets; of several the one on top, then the one of the lowest id. None where there is none.
    /// O(log faces). Safe to call from any thread.
    SurfaceId facing(const Point& at, const Vec3& direction) const;

  private:
    const Scene* scene_;
    double tolerance_;
    Field<SurfaceId, char> is_opposed_;  ///< 1 or 0; empty if no face is.
    std::vector<SurfaceId> faces_;       ///< Those in the tree.
    Bvh tree_;
};

}  // namespace exitance

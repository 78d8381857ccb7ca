#pragma once

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Finds the visible face where faces of one plane have both orientations, like the two sides of a sheet with different
/// outlines. A ray that hits such a plane must hit the face whose front it meets, whichever of them the search in
/// single precision returns. The scene must outlive this object. O(faces) to build.
class OpposedFaces {
  public:
    /// other_side  as returned by other_sides_of_surfaces(): planes in which all faces have another side are omitted
    /// tolerance   metres; planes at a smaller distance are equal
    OpposedFaces(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, double tolerance);

    /// True if the face is one of the opposed faces.
    bool has(SurfaceId s) const { return is_opposed_.size() > 0 && is_opposed_[s] != 0; }

    std::span<const SurfaceId> faces() const { return faces_; }

    /// Returns the face whose plane and outline contain `at` (metres), within the tolerance, and whose front a ray
    /// along `direction` meets. Among several it is the top one, then the one with the lowest id. None if there is no
    /// such face. O(log faces). Thread-safe.
    SurfaceId facing(const Point& at, const Vec3& direction) const;

  private:
    const Scene* scene_;
    double tolerance_;
    Field<SurfaceId, char> is_opposed_;  ///< 1 for opposed faces, else 0; empty if no face is opposed.
    std::vector<SurfaceId> faces_;       ///< Faces in the order of the tree's items.
    Bvh tree_;
};

}  // namespace exitance

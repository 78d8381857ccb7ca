#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// True if all corners of an outline are within `distance` metres of a plane. Two faces are stacked if one of them is
/// that close to the other's plane: the space between them counts as nothing. Faces that touch along an edge are not
/// stacked, however small their angle is.
bool is_within(std::span<const Point> outline, const Plane& plane, double distance);

/// Finds the faces that cross the space just above a region, like the other side of a sharp wedge near its edge. A ray
/// from there that starts at the usual height above the region would start behind that face. Also finds the faces that
/// are stacked on a region and face the same way, like a rug on a floor: no ray leaves the places below them. Faces of
/// which less than 2e-4 is below others are left out. The scene must outlive this object. Immutable; safe to share
/// between threads. Memory O(gaps); O(faces log faces) to build.
class NarrowGaps {
  public:
    /// reach  height above each region up to which faces are found, metres; one value per region
    /// raised  height by which rays meet each region above its plane (Region::level), metres; one value per region
    NarrowGaps(const Scene& scene, const Field<RegionId, double>& reach, const Field<RegionId, double>& raised);

    /// True if any face crosses the space above the region.
    bool has(RegionId own) const { return !own.is_none() && has_gap_.size() > 0 && has_gap_[own] != 0; }

    /// Returns a face that is stacked on the region at its point x and faces the same way; none if there is none.
    SurfaceId cover(const Point& x, RegionId own) const;

    /// Height of the lowest face above the point x of region `own`, along the region's normal, metres; infinite if
    /// there is none within reach. Stacked faces do not count. About 0.1 us.
    double height(const Point& x, RegionId own) const;

    struct Met {
        SurfaceId surface;  ///< None if nothing is met.
        double distance;    ///< In units of the direction's length.
        bool front;
    };
    /// Finds the first of the faces close above x that a ray from x meets, in double precision.
    Met first(const Point& x, const Vec3& direction, RegionId own) const;

    /// True if first() decides whether a ray from x meets the surface.
    bool decides(const Point& x, RegionId own, SurfaceId surface) const;

  private:
    struct Gap {
        RegionId own;
        SurfaceId above;
        bool is_stacked;
    };
    /// Calls visit(face) for the faces above a region whose box contains the point below them.
    template <class Visit>
    void visit(const Point& x, RegionId own, bool are_stacked, const Visit& visit) const;

    Plane raised_plane(SurfaceId s) const;

    const Scene* scene_;
    double rounding_;  ///< Metres: faces nearer than this to a point touch it.
    Field<RegionId, double> reach_, raised_;
    Field<RegionId, char> has_gap_;  ///< 1 for regions with gaps; empty if there are none.
    std::vector<Gap> gaps_;          ///< In the order of the tree's items.
    Bvh tree_;                       ///< Boxes of the points below the faces.
};

}  // namespace exitance

#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// For every face or region: the one with the same corners and the opposite orientation (the other side of a sheet), or
/// none. Empty if there are no such pairs. Corners are equal if they are equal in single precision, relative to the
/// scene's centre. O(corners).
Field<SurfaceId, SurfaceId> other_sides_of_surfaces(const Scene& scene);
Field<RegionId, RegionId> other_sides_of_regions(const Scene& scene);

/// True if the face is the second side of a sheet, so that the first has the same geometry. False if one of the sides
/// lies on another face. `other_side`: of surfaces.
bool is_second_side(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, SurfaceId side);

}  // namespace exitance

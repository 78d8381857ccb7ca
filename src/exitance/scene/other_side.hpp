#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Of every face, or region: the one of the same corners that faces the other way, as the two sides of a sheet do; none
/// else. Empty where none has one. Corners are the same when they are in single precision, relative to the scene's
/// middle. O(corners).
Field<SurfaceId, SurfaceId> other_sides_of_surfaces(const Scene& scene);
Field<RegionId, RegionId> other_sides_of_regions(const Scene& scene);

/// Is this the second of the two sides of a sheet, so that the first stands where it does? Not where one of them lies
/// on something. `other_side`: of surfaces.
bool is_second_side(const Scene& scene, const Field<SurfaceId, SurfaceId>& other_side, SurfaceId side);

}  // namespace exitance

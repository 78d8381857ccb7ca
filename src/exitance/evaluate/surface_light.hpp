#pragma once

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Mean light of one input face, W/m^2.
struct SurfaceLight {
    Spectrum irradiance, radiosity;
};

/// Means over every input face, from the interpolant. Where a region has several faces, its leaves are cut along them,
/// so that the figures belong to the faces as they stand in the file. Exact for the interpolant. O(leaves log faces).
Field<SurfaceId, SurfaceLight> mean_light(const Solution& solution);

/// The integral of an element function over a polygon in the plane of one of its leaves (m^2 W/m^2), the leaf's
/// polynomial going on beyond the leaf. `outline` may run to and fro, as clip() leaves it. Exact: three points a
/// triangle integrate a quadratic polynomial.
Spectrum integral(const ElementFunction& function, ElementId leaf, std::span<const Point> outline, const Normal& n);

}  // namespace exitance

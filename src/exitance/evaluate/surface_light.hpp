#pragma once

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Mean light of one input face, W/m^2.
struct SurfaceLight {
    Spectrum irradiance, radiosity;
};

/// Mean light of every input face, from the interpolant. Leaves of a region with several faces are clipped to the
/// faces, so that the values belong to the faces of the file. Exact for the interpolant. O(leaves log faces).
Field<SurfaceId, SurfaceLight> mean_light(const Solution& solution);

/// Integral of a leaf's polynomial, extended beyond the leaf, over a polygon in its plane, m^2 W/m^2. `outline` may
/// have edges that coincide in opposite directions, as clip() returns it. Exact: three points per triangle integrate a
/// quadratic polynomial.
Spectrum integral(const ElementFunction& function, ElementId leaf, std::span<const Point> outline, const Normal& n);

}  // namespace exitance

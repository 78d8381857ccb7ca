#pragma once

#include <span>

#include "exitance/base/vec.hpp"
#include "exitance/scene/emission_profile.hpp"

namespace exitance {

/// Irradiance at a point over the exitance of a polygon whose radiance depends on direction, nothing in between:
///
///     F_p = integral of p(y -> x) dF = integral of  p(y -> x) cos cos / (pi r^2) dA
///
/// The polygon is cut into triangles. A triangle's part is its form factor, which is exact, times the mean of p over
/// six places of a rule of degree 4, which weigh as the kernel has it. It is bisected where it looks wider than the
/// profile is smooth, or where three places say otherwise. Far polygons are two triangles. Relative error 1e-3 at most,
/// as a rule 2e-4; where p is less than a fiftieth of its mean it is relative to that. About 60 ns a place; a far
/// quadrangle takes 20, an opening of a metre at half a metre 400 to 5000 by its profile.
/// n        the point's normal
/// corners  of a convex polygon relative to the point, all above its horizon, counter-clockwise seen from its front
/// p        of its face
double directed_form_factor(const Normal& n, std::span<const Vec3> corners, const RelativeRadiance& p);

}  // namespace exitance

#pragma once

#include <span>

#include "exitance/geometry/vec.hpp"

namespace exitance {

/// A place of a convex polygon of that area (m^2) with uniform density, from two numbers in [0, 1).
Point uniform_on(std::span<const Point> corners, double area, double s, double t);

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/measure/measuring_grid.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// The points of a grid as a picture of one pixel each, the first row at the bottom; those that do not count are empty.
Picture picture_of_points(const GridLight& light, const std::vector<double>& values);

/// The same with light between the points, by bilinear interpolation, about `wanted` pixels wide; what hides a point
/// hides its cell.
Picture smooth_picture(const Picture& points, int wanted);

/// A pixel of one value.
Pixel lit_pixel(double value);

/// A piece of a line of equal light, in the plan's units, y downwards.
struct ContourSegment {
    Vec2 a, b;
};

/// Lines of equal light in a picture that fills a plan of that size: marching squares, [Lorensen87] in the plane.
std::vector<ContourSegment> contour(const Picture& picture, Vec2 plan, double level);

}  // namespace exitance

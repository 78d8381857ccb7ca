#pragma once

#include <vector>

#include "exitance/measure/measuring_grid.hpp"
#include "exitance/measure/pictures/picture.hpp"

namespace exitance {

/// A picture with one pixel per grid point, the first row at the bottom. Pixels of points covered by objects are empty.
Picture picture_of_points(const GridLight& light, const std::vector<double>& values);

/// Interpolates such a picture bilinearly to a width of about `wanted` pixels. The cell around a covered point is
/// empty.
Picture smooth_picture(const Picture& points, int wanted);

/// A visible pixel with this irradiance in all bands.
Pixel lit_pixel(double value);

/// A segment of an isoline, in the plan's units, y downwards.
struct ContourSegment {
    Vec2 a, b;
};

/// Isolines of `level` in a picture that is scaled to the size `plan`: marching squares, the 2D form of [Lorensen87].
std::vector<ContourSegment> contour(const Picture& picture, Vec2 plan, double level);

}  // namespace exitance

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/measure/measuring_grid.hpp"

namespace exitance {

/// Planes on which lighting standards have light measured: over the floors of a scene, or over faces that have a name.
struct PlaneRequest {
    std::string group;             ///< Faces of this name; empty: the floors.
    std::optional<double> height;  ///< Above them, metres; none: on them.
    std::optional<double> border;  ///< Strip along the outline that does not count, metres; none: default_border.
    double spacing = 0;            ///< As MeasuringPlane::spacing.
    bool is_cylindrical = false;   ///< E_z, the mean of the illuminances of vertical planes of all directions.
};

/// The strip that EN 12464-1 leaves out along walls, 0.5 m, or 15% of the shorter side where that would be more than a
/// quarter of it; nothing where light is measured on the faces themselves. Metres.
double default_border(double length, double width, bool is_above);

/// Grids over what a request names, one over every group of coplanar faces that touch one another, along their longest
/// edge; those over less than a tenth of the largest one are left out, and the 32 largest remain. Points of the grid
/// outside of the faces' outline, or nearer to it than the border, do not count. Floors are the faces that point up at
/// the lowest level at which there is one of at least a tenth of the area of the largest. Of faces with a name those
/// that point up count, if there are any. Errors of code `usage`: no such faces, nothing is left within the border, or
/// more than 100,000 points.
Result<std::vector<GridLight>> make_working_planes(const Scene& scene, const PlaneRequest& request);

}  // namespace exitance

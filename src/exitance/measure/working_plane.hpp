#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/measure/measuring_grid.hpp"

namespace exitance {

class FloorRooms;

/// Planes on which lighting standards require measurements: above the floors of a scene, or above named faces.
struct PlaneRequest {
    std::string group;             ///< Name of the faces; empty: the floors.
    std::optional<double> height;  ///< Height of the plane above the faces, metres; none: on the faces themselves.
    /// Width of the strip along the outline that does not count, metres; none: default_border.
    std::optional<double> border;
    double spacing = 0;  ///< See MeasuringPlane::spacing.
    /// Width of the immediate surroundings to be measured around named faces, metres; none: they are not measured.
    std::optional<double> surroundings;
    /// Width of the background to be measured around the surroundings, metres; none: it is not measured.
    std::optional<double> background;
    bool is_cylindrical = false;  ///< Measure E_z, the mean illuminance of vertical planes of all directions.
};

/// Width of the strip along walls that EN 12464-1 excludes, metres: 0.5 m, or 15% of the shorter side if 0.5 m is more
/// than a quarter of that side; 0 if light is measured on the faces themselves.
double default_border(double length, double width, bool is_above);

/// Makes the grids of a request: one per room above the floors, or one per group of coplanar faces of the name that
/// touch each other (at most 32, none below a tenth of the largest). Points outside the room or the faces' outline, or
/// nearer to its walls or outline than the border, do not count. Of named faces, those that point up are used, if there
/// are any. Errors of code `usage`: no such faces, no point within the border, or more than 100,000 points.
Result<std::vector<GridLight>> make_working_planes(const Scene& scene, const FloorRooms& rooms,
                                                   const PlaneRequest& request);

}  // namespace exitance

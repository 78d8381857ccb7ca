#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// A plane to measure on: the parallelogram origin + s u + t v, s and t from 0 to 1, metres. Light is measured that
/// arrives from the side where u x v points.
struct MeasuringPlane {
    Point origin;
    Vec3 u, v;
    double spacing = 0;  ///< Largest distance of neighbouring points along an edge, metres; 0: en_12464_spacing.
    double margin = 0;   ///< Strip along all edges that is not measured, metres.
};

/// The grid of EN 12464-1: p = 0.2 * 5^log10(d), at most 10 m; d the longer side of a plane, or the shorter one where
/// the longer one has at least twice its length. Metres.
double en_12464_spacing(double length, double width);

/// Light on a plane, measured in the middle of equal cells.
struct GridLight {
    MeasuringPlane plane;
    Normal n;
    int columns = 0, rows = 0;         ///< Along u and v.
    double step_u = 0, step_v = 0;     ///< Metres.
    std::vector<Point> points;         ///< Row by row, from the origin on.
    std::vector<Spectrum> irradiance;  ///< Of every point, W/m^2.
    /// Which of them lie in the open, and not below something that stands there: only these count.
    std::vector<bool> is_open;
    std::vector<bool> counts;     ///< Of every point: does it belong to what is measured? Empty: all do.
    bool is_cylindrical = false;  ///< E_z at the points: the mean over vertical planes of all directions.
    std::string name;             ///< Empty: none.
};

/// Where a plane is measured. Errors of code `usage`: a plane without area, a margin that leaves nothing, more than
/// 100,000 points.
Result<GridLight> make_grid(const MeasuringPlane& plane);

/// Fills in the light, as `probe` gives it: exact direct light, indirect light from the elements on surfaces, from rays
/// in free space (about 1 ms a point there). Points that do not count have none, and are not open.
/// Cylindrical illuminance is the mean of `cylinder_planes` vertical planes: what light from one place comes to is off
/// by at most 8e-4, from all around much less.
constexpr int cylinder_planes = 25;  // odd: what is off is of the order of the square of twice as many
void measure(const RadiosityFunction& light, GridLight& grid, Progress& progress, const StopRequest& stop);

/// Mean, least and largest of some values, and their uniformity, as lighting standards define it.
struct Levels {
    double mean = 0, least = 0, most = 0;
    std::size_t count = 0;

    double uniformity() const { return mean > 0 ? least / mean : 0; }  ///< U0; 0 in the dark.
    double diversity() const { return most > 0 ? least / most : 0; }   ///< Ud; 0 in the dark.
};
Levels levels_of(std::span<const double> values);

}  // namespace exitance

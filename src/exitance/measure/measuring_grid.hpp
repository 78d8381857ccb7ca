#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// A plane on which light is measured: the parallelogram origin + s u + t v, s and t from 0 to 1, metres. Only light
/// that arrives from the side to which u x v points is measured.
struct MeasuringPlane {
    Point origin;
    Vec3 u, v;
    double spacing = 0;  ///< Largest distance of neighbouring points along an edge, metres; 0: en_12464_spacing.
    double margin = 0;   ///< Width of the strip along all edges that is not measured, metres.
};

/// Grid spacing according to EN 12464-1: p = 0.2 * 5^log10(d), at most 10 m. d is the longer side of the plane, or the
/// shorter one if the longer one has at least twice its length. Metres.
double en_12464_spacing(double length, double width);

/// Part of a working place that a plane measures, by EN 12464-1: the task area or a whole room, the band around the
/// task area, and the band around that.
enum class PlaneZone : std::uint8_t { task, surroundings, background };
const char* name_of(PlaneZone zone);

/// Light on a plane, measured at the centres of equal cells.
struct GridLight {
    MeasuringPlane plane;
    Normal n;
    int columns = 0, rows = 0;         ///< Numbers of points along u and v.
    double step_u = 0, step_v = 0;     ///< Metres.
    std::vector<Point> points;         ///< Points, row by row, starting at the origin.
    std::vector<Spectrum> irradiance;  ///< Irradiance at every point, W/m^2.
    /// For every point, true unless an object covers it; only such points count.
    std::vector<bool> is_open;
    std::vector<bool> counts;  ///< For every point, true if it belongs to the measured area. Empty: all do.
    /// True for cylindrical illuminance E_z, the mean over vertical planes of all directions.
    bool is_cylindrical = false;
    PlaneZone zone = PlaneZone::task;
    std::string name;                 ///< Name of the plane; empty: none.
    std::optional<std::size_t> room;  ///< Index of the room that contains the plane; none: not in a room.
};

/// Returns the grid of a plane. Errors of code `usage`: a plane without area, a margin that leaves no area, more than
/// 100,000 points.
Result<GridLight> make_grid(const MeasuringPlane& plane);

constexpr int cylinder_planes = 25;  // odd: the error is of the order of the inverse square of twice the number
/// Computes the light at the points, as `probe` does: exact direct light, and indirect light from the elements on
/// surfaces or from rays in free space (about 1 ms per point). Points that do not count get no light and are not open.
/// Cylindrical illuminance is the mean of `cylinder_planes` vertical planes. The error is at most 8e-4 for light from
/// one direction, and much less for light from all around.
void measure(const RadiosityFunction& light, GridLight& grid, Progress& progress, const StopRequest& stop);

/// Mean, minimum and maximum of some values, and their uniformity as defined by lighting standards.
struct Levels {
    double mean = 0, least = 0, most = 0;
    std::size_t count = 0;

    double uniformity() const { return mean > 0 ? least / mean : 0; }  ///< U0 of EN 12464-1; 0 in the dark.
    double diversity() const { return most > 0 ? least / most : 0; }   ///< Ud of EN 12464-1; 0 in the dark.
};
Levels levels_of(std::span<const double> values);

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// The planes of a file of type C as they stand there: angles about the vertical, rising, and a row of intensities
/// each.
struct Planes {
    std::vector<double> angle;  ///< Degrees.
    std::vector<std::vector<double>> rows;
};

/// Writes out the symmetry of planes from 0 to 90 (in quadrants), from 0 to 180 (about the plane of C0), or from 90 to
/// 270 (about that of C90); closes a circle that stops before 360 with its first plane. The result goes from 0 to 360.
/// The angles must be one of these; see has_known_range.
Planes completed(const Planes& planes);

/// One plane at 0, 0..90, 0..180, 90..270, 0..360, or 0.. beyond 180.
bool has_known_range(const std::vector<double>& angles);

/// A table over -m..m from one over 0..m, both ends included.
void mirror(std::vector<double>& at, std::vector<std::vector<double>>& rows);
std::vector<std::vector<double>> transposed(const std::vector<std::vector<double>>& rows);

/// Planes at angles from -90 to 90 as a circle from 0 to 360: those below 0 as 360 less, and 0 in between.
Planes around_axis(const std::vector<double>& around, const std::vector<std::vector<double>>& rows);

/// Puts planes (from completed(), or one) into the table, 0 beyond the vertical angles given.
void set_table(Photometry& p, std::vector<double> theta, const Planes& planes);

}  // namespace exitance

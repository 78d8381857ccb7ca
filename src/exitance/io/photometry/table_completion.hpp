#pragma once

#include <vector>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// Planes of a type C file before completion: their angles about the vertical, ascending, and one row of intensities
/// per plane.
struct Planes {
    std::vector<double> angle;  ///< Degrees.
    std::vector<std::vector<double>> rows;
};

/// Completes planes by their symmetry: from 0 to 90 (quadrants), from 0 to 180 (symmetric about the C0 plane), or from
/// 90 to 270 (about the C90 plane). If they end before 360, the first plane is repeated there. Returns planes from 0 to
/// 360. The angles must satisfy has_known_range().
Planes completed(const Planes& planes);

/// True for one plane, or planes over 0..90, 0..180, 90..270, 0..360, or from 0 to any angle above 180.
bool has_known_range(const std::vector<double>& angles);

/// Extends a table over 0..m to -m..m by symmetry.
void mirror(std::vector<double>& at, std::vector<std::vector<double>>& rows);
std::vector<std::vector<double>> transposed(const std::vector<std::vector<double>>& rows);

/// Converts planes at angles from -90 to 90 to a circle from 0 to 360; in the other half the intensity is 0.
Planes around_axis(const std::vector<double>& around, const std::vector<std::vector<double>>& rows);

/// Stores planes, one or from completed(), in the table. Beyond the given vertical angles the intensity is 0.
void set_table(Photometry& p, std::vector<double> theta, const Planes& planes);

}  // namespace exitance

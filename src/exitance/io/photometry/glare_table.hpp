#pragma once

#include <string>
#include <vector>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// A room of the standard table: its sizes across and along the line of sight in mounting heights H above the eye, its
/// reflectances, and the UGR of somebody who sits in the middle of the wall that Y leads away from.
struct GlareTableRow {
    double x = 2, y = 2;
    double ceiling = 0.7, walls = 0.5, floor = 0.2;
    double crosswise = 0;  ///< Looking along the luminaires' plane C0, at right angles to tubular lamps,
    double endwise = 0;    ///< and along C90. Not finite where nothing glares.
};

/// The standard table of UGR after [CIE190]: nineteen rooms, five sets of reflectances. The luminaires hang in the
/// ceiling, H = 2 m above the eye, 0.25 H apart, the first half as far from the walls. Their direct flux goes to walls
/// and to the plane of the eye by the file's intensities (sampled by 1 and 2.5 degrees) and is reflected by the three
/// surfaces of that box; L_b is the mean indirect illuminance of the walls over pi. Every luminaire that CIE 117 counts
/// (`glare_limit`) has L = I / A and omega = A / r^2 in its middle, A the projected area of its opening; a point has
/// the area of a small source. Values are for the file's own flux. Of eleven public luminaires the means of the table
/// lie within 0.2 of Relux's and, above a UGR of 10, within 0.3 of DIALux's. About 50 ms.
std::vector<GlareTableRow> make_glare_table(const Photometry& photometry);

/// As CSV: ceiling,walls,floor,X,Y,crosswise,endwise; reflectances in percent, X and Y in H.
std::string glare_table_csv(const std::vector<GlareTableRow>& table);

}  // namespace exitance

#pragma once

#include <string>
#include <vector>

#include "exitance/io/photometry/photometry.hpp"

namespace exitance {

/// A room of the standard table, with the UGR of an observer in the middle of a wall, whose line of sight is along Y.
/// The sizes, across (X) and along (Y) the line of sight, are in units of the mounting height H above the eye.
struct GlareTableRow {
    double x = 2, y = 2;
    double ceiling = 0.7, walls = 0.5, floor = 0.2;
    /// UGR for a line of sight along the luminaires' C0 plane, at right angles to tubular lamps.
    double crosswise = 0;
    double endwise = 0;  ///< UGR along the C90 plane. Not finite if there is no glare.
};

/// Computes the standard UGR table after [CIE190]: nineteen rooms, five sets of reflectances. Luminaires hang in the
/// ceiling, H = 2 m above the eye, 0.25 H apart, with half that distance to the walls.
/// Background: the direct flux to the walls and to the plane of the eye follows from the file's intensities (sampled
/// every 1 and 2.5 degrees) and is reflected between the three surfaces of that box. L_b is the mean indirect
/// illuminance of the walls over pi.
/// Sources: every luminaire that CIE 117 counts (`glare_limit`) has L = I / A and omega = A / r^2 at its centre, where
/// A is the projected area of its opening. A point has the area of a small source.
/// Values are for the file's own flux. For eleven public luminaires, the means of the table are within 0.2 of Relux's
/// and, above a UGR of 10, within 0.3 of DIALux's. Takes about 50 ms.
std::vector<GlareTableRow> make_glare_table(const Photometry& photometry);

/// Formats a table as CSV: ceiling,walls,floor,X,Y,crosswise,endwise; reflectances in percent, X and Y in units of H.
std::string glare_table_csv(const std::vector<GlareTableRow>& table);

}  // namespace exitance

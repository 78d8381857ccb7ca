#pragma once

#include <string>

#include "exitance/io/scenes/view3d_controls.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {

/// Formats a table as View3D's output. Text (`out` 0): a header of 30 characters, areas, rows to six decimals (error up
/// to 5e-7), emittances. Binary (`out` 1): a header of 32 bytes, then 32-bit floats of the machine's byte order: areas,
/// rows, emittances. Exchange areas (`out` 2, which View3D's sources define but its program refuses): a header, the
/// title, a line with number, area, emittance and name for each row i, and below it A_i F_ij for j <= i, five in a
/// line. Error (bad_input): another format; View3D defines none.
Result<std::string> view3d_output(const SparseFactors& table, const View3dControls& controls);

}  // namespace exitance

#pragma once

#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

/// Controls of a View3D input file (.vs3) that concern the result. Other controls steer View3D's integration.
struct View3dControls {
    double eps = 1e-4;            ///< Convergence of View3D's integration.
    int row = 0, col = 0;         ///< The only row and column that View3D computes; 0: all.
    bool is_enclosure = false;    ///< `encl`: rows are adjusted so that they add up to 1.
    bool has_emittances = false;  ///< `emit`: the result are exchange factors of the gray surfaces (script F).
    int out = 0;                  ///< Format of the result; 0: text, 1: binary, 2: exchange areas with names.
    std::string title;            ///< Text of the last `T` line.
};

/// Items of a line of a .vs3 file, separated by blanks: without its comment, and without commas and equals signs.
std::string view3d_items(std::string_view line);

/// Name of a control in lower case; View3D accepts either case.
std::string view3d_control_name(std::string_view word);

/// True if View3D has a control of this name, which is in lower case.
bool is_view3d_control(std::string_view name);

/// Reads the `C` and `T` lines of a .vs3 file; the last value of a control counts. Errors: cannot_read, and bad_input
/// for an integer control whose value is not one.
Result<View3dControls> read_view3d_controls(const std::string& path);

}  // namespace exitance

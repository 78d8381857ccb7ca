#pragma once

#include "exitance/io/scenes/radiance/rad_command.hpp"

namespace exitance {

/// True for `genbox material name x y z`, with no option but -i (fronts inside). Boxes with round or bevelled edges
/// need the program itself.
bool is_box_command(const CommandWords& words);

/// Returns the six polygons that genbox prints for a box from the origin to (x, y, z), metres, with genbox's names,
/// which list the corners (bit 0: x, bit 1: y, bit 2: z). Error: a size that is not a number above 0.
Result<std::string> box_command_output(const CommandWords& words);

}  // namespace exitance

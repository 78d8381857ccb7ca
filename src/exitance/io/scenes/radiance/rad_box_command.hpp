#pragma once

#include "exitance/io/scenes/radiance/rad_command.hpp"

namespace exitance {

/// Is it `genbox material name x y z`, with at most -i (faces turned inwards), whose box is plain? Round and bevelled
/// edges are left to the program.
bool is_box_command(const CommandWords& words);

/// The six polygons that such a command prints: a box from the origin to x, y, z, metres, named as genbox names them
/// by the corners (bit 0: x, bit 1: y, bit 2: z). An error where a size is no number above 0.
Result<std::string> box_command_output(const CommandWords& words);

}  // namespace exitance

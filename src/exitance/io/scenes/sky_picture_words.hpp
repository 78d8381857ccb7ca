#pragma once

#include <string>

#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// True if the words of --sky describe a sky from a picture: "image=FILE", then rotation and scale.
bool is_picture_sky(const std::string& words);

/// Reads the picture that the words name, as a sky. Errors: usage for the words; cannot_read and bad_input for the
/// picture.
Result<ChosenSky> parse_picture_sky(const std::string& words);

}  // namespace exitance

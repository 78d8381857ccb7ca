#pragma once

#include <optional>
#include <string>

#include "exitance/error.hpp"
#include "exitance/io/scenes/scene_file.hpp"

namespace exitance::api {

/// The sky that `words` describe, with the weather of the file `epw`; none if `words` are empty. Warnings about the
/// weather file are in ChosenSky::warnings. Errors: usage, cannot_read, bad_input.
Result<std::optional<ChosenSky>> read_sky(const std::string& words, const std::string& epw);

}  // namespace exitance::api

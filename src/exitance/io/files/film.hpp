#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Is this the ending of a video that `write_film` makes: .mp4, .mkv, .webm, .gif?
bool is_film(const std::string& path);

/// An error that says what to do where ffmpeg is not in PATH.
Result<void> find_film_program(const std::string& path);

/// Makes a video of the pictures frame.0001.png, frame.0002.png, ... of a folder, `rate` of them a second, by ffmpeg,
/// with the codec that it takes for the ending. The video appears whole or not at all.
Result<void> write_film(const std::string& folder, double rate, const std::string& path);

}  // namespace exitance

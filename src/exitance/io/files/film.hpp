#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// True if the path has the ending of a video that `write_film` supports: .mp4, .mkv, .webm, .gif.
bool is_film(const std::string& path);

/// Returns an error with advice if ffmpeg is not in PATH.
Result<void> find_film_program(const std::string& path);

/// Encodes the pictures frame.0001.png, frame.0002.png, ... in `folder` as a video, with ffmpeg's default codec for the
/// ending of `path`. `rate` is in pictures per second. The video appears whole or not at all.
Result<void> write_film(const std::string& folder, double rate, const std::string& path);

}  // namespace exitance

#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"

namespace exitance {

/// Is it the name of a program of Radiance's that makes or changes scene descriptions on its standard output?
bool is_scene_program(const std::string& name);

/// What a program (the first of `words`, looked up in PATH) prints when it is given `input` on its standard input. No
/// shell has a hand in it. It runs in `folder` and in a process group of its own, which ends when a stop is asked for.
/// Errors: bad_input where there is no such program, where it fails (with the first line that it says), or prints more
/// than 256 MB; limit where a stop was asked for.
Result<std::string> run_scene_program(const std::vector<std::string>& words, const std::string& input,
                                      const std::string& folder, const StopRequest& stop);

}  // namespace exitance

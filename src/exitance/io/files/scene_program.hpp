#pragma once

#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"

namespace exitance {

/// True if `name` is a Radiance program that writes or changes scene descriptions on its standard output.
bool is_scene_program(const std::string& name);

/// Runs a program without a shell and returns its standard output.
/// words   the program, looked up in PATH, and its arguments
/// input   text for its standard input
/// folder  its working folder
/// stop    ends the program's process group when a stop is requested
/// Errors: bad_input if there is no such program, if it fails (with the first line of its error output), or if it
/// prints more than 256 MB; limit if a stop was requested.
Result<std::string> run_scene_program(const std::vector<std::string>& words, const std::string& input,
                                      const std::string& folder, const StopRequest& stop);

}  // namespace exitance

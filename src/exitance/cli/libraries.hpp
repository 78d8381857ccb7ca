#pragma once

namespace exitance {

/// Names and versions of the libraries that the program was built with, separated by commas.
extern const char* const program_libraries;

}  // namespace exitance

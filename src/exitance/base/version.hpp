#pragma once

namespace exitance {

/// Version of the program and its libraries, such as "0.3.0". It is set in CMakeLists.txt only.
extern const char* const program_version;

}  // namespace exitance

#include "exitance/cli/libraries.hpp"

namespace exitance {

const char* const program_libraries = EXITANCE_LIBRARIES;

}  // namespace exitance

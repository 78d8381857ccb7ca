#include "exitance/base/version.hpp"

namespace exitance {

const char* const program_version = EXITANCE_VERSION;

}  // namespace exitance

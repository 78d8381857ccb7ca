#include "exitance/lab/laboratory.hpp"

namespace exitance::test {

/// Tests use the methods of the laboratory like those of the engine.
const bool is_laboratory_there = (install_laboratory(), true);

}  // namespace exitance::test

#include "exitance/lab/laboratory.hpp"

namespace exitance::test {

/// The same for tests that are linked without the reading and writing of files.
const bool are_lab_methods_there = (install_lab_methods(), true);

}  // namespace exitance::test

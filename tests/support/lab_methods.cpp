#include "exitance/lab/laboratory.hpp"

namespace exitance::test {

/// Installs the methods of the laboratory, for tests that are linked without code for files.
const bool are_lab_methods_there = (install_lab_methods(), true);

}  // namespace exitance::test

#include "support/places.hpp"

namespace exitance::test {

std::string source_folder() {
    return EXITANCE_SOURCE_DIR;
}

std::string shared_folder() {
    return EXITANCE_SHARED_DIR;
}

std::string program() {
    return EXITANCE_PROGRAM;
}

std::string mpirun() {
    return EXITANCE_MPIRUN;
}

}  // namespace exitance::test

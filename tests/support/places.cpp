#include "support/places.hpp"

namespace exitance::test {

std::string source_folder() {
    return EXITANCE_SOURCE_DIR;
}

std::string data_folder() {
    return EXITANCE_SOURCE_DIR "/tests/data";
}

std::string program() {
    return EXITANCE_PROGRAM;
}

std::string mpirun() {
    return EXITANCE_MPIRUN;
}

}  // namespace exitance::test

// Entry of clang's libFuzzer: exitance-libfuzzer with EXITANCE_FUZZ_READER naming the reader.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "exitance/core/parallel.hpp"
#include "fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace exitance::fuzz;
    static const Target* const target = [] {
        exitance::set_threads(1);
        const char* name = std::getenv("EXITANCE_FUZZ_READER");
        const Target* found = find_target(name ? name : "obj");
        return found ? found : std::abort(), found;
    }();
    target->read(std::string(reinterpret_cast<const char*>(data), size));
    return 0;
}

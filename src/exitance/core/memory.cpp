#include "exitance/core/memory.hpp"

#include <sys/resource.h>

namespace exitance {

std::size_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts it in KiB
}

}  // namespace exitance

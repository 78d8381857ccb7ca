#include "exitance/core/memory.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace exitance {

std::size_t peak_memory_bytes() {
    // What `getrusage` tells begins with the memory of the process that has started this one.
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::size_t kibibytes = 0;
        if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts it in KiB
}

std::size_t machine_memory_bytes() {
    return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void keep_large_arrays_apart() {
#ifdef __GLIBC__
    // Else the library takes larger and larger arrays from its heap, in whose gaps much of the memory stays.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

void release_freed_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace exitance

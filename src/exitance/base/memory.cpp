#include "exitance/base/memory.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <string>
#include <string_view>

namespace exitance {
namespace {

/// Reads the value of `name` (KiB) from a file in /proc; returns bytes, or 0 if the system does not report it.
std::size_t proc_bytes(const char* file, std::string_view name) {
    std::ifstream in(file);
    for (std::string word; in >> word;)
        if (std::size_t kibibytes = 0; word == name && in >> kibibytes) return kibibytes * 1024;
    return 0;
}

}  // namespace

std::size_t peak_memory_bytes() {
    // `getrusage` is only the fallback: its value includes the memory of the parent process before exec.
    if (const std::size_t own = proc_bytes("/proc/self/status", "VmHWM:"); own > 0) return own;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts it in KiB
}

std::size_t proportional_memory_bytes() {
    return proc_bytes("/proc/self/smaps_rollup", "Pss:");
}

double processor_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::size_t machine_memory_bytes() {
    return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void keep_large_arrays_apart() {
#ifdef __GLIBC__
    // Unless this threshold is set, glibc raises it as arrays are freed. Large arrays would then be allocated on the
    // heap, where gaps keep much of the memory.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

void release_freed_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace exitance

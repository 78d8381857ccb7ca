#include "exitance/base/available_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "exitance/base/memory.hpp"

namespace exitance {
namespace {

/// Reads a line "Name: KIBIBYTES kB" of a file in /proc; returns bytes, or 0 if there is no line of that name.
std::size_t kernel_number(const char* file, const std::string& name) {
    std::ifstream in(file);
    for (std::string word; in >> word;)
        if (std::size_t kibibytes = 0; word == name && in >> kibibytes) return kibibytes * 1024;
    return 0;
}

/// Returns the directory of the process's control group (version 2).
std::string control_group() {
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("0::")) return "/sys/fs/cgroup" + line.substr(3);
    return "/sys/fs/cgroup";
}

}  // namespace

std::size_t resident_memory_bytes(double share_of_common) {
    std::ifstream in("/proc/self/statm");
    double all = 0, resident = 0, common = 0;  // pages
    if (!(in >> all >> resident >> common)) return 0;
    const double pages = resident - (1 - share_of_common) * common;
    return static_cast<std::size_t>(pages) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t available_memory_bytes() {
    std::size_t available = kernel_number("/proc/meminfo", "MemAvailable:");
    if (available == 0) available = machine_memory_bytes();
    std::size_t limit = 0, used = 0;
    std::ifstream limit_file(control_group() + "/memory.max"), used_file(control_group() + "/memory.current");
    if (limit_file >> limit && used_file >> used) available = std::min(available, limit - std::min(limit, used));
    return available;
}

}  // namespace exitance

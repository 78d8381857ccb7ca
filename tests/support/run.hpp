#pragma once

#include <cstdio>
#include <string>

#include "support/temporary_folder.hpp"

namespace exitance {

/// Output of a command, on both streams, and its exit status.
struct Ran {
    int status = -1;
    std::string output;
};
inline Ran run(const std::string& command) {
    Ran ran;
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return ran;
    char block[4096];
    while (const std::size_t n = std::fread(block, 1, sizeof block, pipe)) ran.output.append(block, n);
    const int status = ::pclose(pipe);
    ran.status = status < 0 ? -1 : status >> 8 & 0xff;
    return ran;
}

}  // namespace exitance

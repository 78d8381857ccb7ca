#pragma once

#include <cstdint>
#include <string>

#include "fuzz/target.hpp"

namespace exitance::fuzz {

struct AttackOptions {
    double seconds = 60;
    std::uint64_t rounds = ~std::uint64_t(0), seed = 1;
};

/// Installs signal handlers. After that, a crash, 5 s of processor time for one file, or ten minutes of waiting end the
/// process with status 1, and with a message that has the file's path.
void watch_signals();

/// Ends the process in the same way, for a fault without a signal.
[[noreturn]] void end_with_fault();

/// Reads the file at `path` with these limits.
void read_file_watched(const Target& target, const std::string& path);

/// Gives damaged files to a reader until the time is over, and prints their number. Files are made in memory; a faulty
/// one is written to fuzz-READER-SEED-ROUND.bin.
/// Some readers first read every file in a copy of the process, which is slow. For these, a worker process reads
/// hundreds of files in two steps: as that copy would, then as the reader. If the first step crashes, the worker is
/// replaced. If the second step fails, the file is read again by the unchanged reader.
void attack(const Target& target, const AttackOptions& options);

}  // namespace exitance::fuzz

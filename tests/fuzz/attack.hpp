#pragma once

#include <cstdint>
#include <string>

#include "fuzz/target.hpp"

namespace exitance::fuzz {

struct AttackOptions {
    double seconds = 60;
    std::uint64_t rounds = ~std::uint64_t(0), seed = 1;
};

/// From now on a crash, 5 s of the processor for one file, or ten minutes of waiting end the process with status 1, a
/// word about it and the path of the file at fault.
void watch_signals();

/// Ends the process so, for a fault that no signal tells of.
[[noreturn]] void end_with_fault();

/// Reads the file at `path`, watched.
void read_file_watched(const Target& target, const std::string& path);

/// Gives a reader damaged files until the time is over, and says how many they were. Files are made in memory and are
/// written out, as fuzz-READER-SEED-ROUND.bin, when one of them is at fault. A reader that has its files read by a copy
/// of the process first is spared most of those copies: a worker process reads hundreds of files in both steps, and is
/// replaced when the first step breaks it; what goes wrong in the second one is tried out on the reader as it is.
void attack(const Target& target, const AttackOptions& options);

}  // namespace exitance::fuzz

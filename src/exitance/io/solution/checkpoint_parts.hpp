#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

// With several processes, the part of the first one is in the checkpoint file itself. That file is written last and has
// the size and checksum of the other parts, which are separate files in the same folder. Each writing uses its own file
// names (`generation`), so that the previous checkpoint stays complete until the new one replaces it.

/// Expected size, bytes, and checksum of the part of a process.
struct CheckpointPart {
    std::uint64_t size = 0, sum = 0;
};

/// Returns a hash of bytes that detects damage.
std::uint64_t checksum(std::string_view bytes);

/// Path of the part of a process: room.h5.checkpoint.GENERATION.PROCESS.
std::string checkpoint_part_path(const std::string& checkpoint, std::uint64_t generation, std::size_t process);

/// Reads a part. Error (bad_input): it is missing or differs from `expected`.
Result<std::string> read_checkpoint_part(const std::string& checkpoint, std::uint64_t generation, std::size_t process,
                                         const CheckpointPart& expected);

/// Highest generation of the parts in the checkpoint's folder, complete or not; 0: there are none.
std::uint64_t last_checkpoint_generation(const std::string& checkpoint);

/// Removes all parts of the generations in [first, end), including those of interrupted writings.
void remove_checkpoint_parts(const std::string& checkpoint, std::uint64_t first, std::uint64_t end);

}  // namespace exitance

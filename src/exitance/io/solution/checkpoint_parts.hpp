#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

// Where several processes keep a checkpoint, the first one's part stands in the checkpoint itself, which is written
// last and says how the parts of the others have to be; these are files beside it. No two writings have a name in
// common
// (`generation`), so that the checkpoint before stays whole until a new one takes its place.

/// How the part of a process has to be.
struct CheckpointPart {
    std::uint64_t size = 0, sum = 0;
};

/// A hash of bytes, by which damage is noticed.
std::uint64_t checksum(std::string_view bytes);

/// The file of a process's part: room.h5.checkpoint.GENERATION.PROCESS.
std::string checkpoint_part_path(const std::string& checkpoint, std::uint64_t generation, std::size_t process);

/// The part as it was written. Error (bad_input): it is missing, or not as it has to be.
Result<std::string> read_checkpoint_part(const std::string& checkpoint, std::uint64_t generation, std::size_t process,
                                         const CheckpointPart& expected);

/// The last generation of which a part stands beside the checkpoint, whole checkpoint or not; 0: there is none.
std::uint64_t last_checkpoint_generation(const std::string& checkpoint);

/// Removes the parts of generations in [first, end), those of writings that were cut short among them.
void remove_checkpoint_parts(const std::string& checkpoint, std::uint64_t first, std::uint64_t end);

}  // namespace exitance

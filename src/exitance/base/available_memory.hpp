#pragma once

#include <cstddef>

namespace exitance {

/// Returns the current resident memory of the process, bytes. Pages that may be shared with other processes (of files
/// and of shared memory) are multiplied by `share_of_common`. 0 if the system does not report it. About 10 us.
std::size_t resident_memory_bytes(double share_of_common = 1);

/// Returns how much more memory the process can allocate, bytes: the machine's memory that is available without
/// swapping, limited by the rest of its control group's limit. If the system reports neither, the machine's physical
/// memory.
std::size_t available_memory_bytes();

}  // namespace exitance

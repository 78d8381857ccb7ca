#pragma once

#include <cstddef>

namespace exitance {

/// The resident memory of the process now, bytes. Pages that it may have in common with others (of files and of shared
/// memory) count by `share_of_common`. 0 where the system does not report it. About 10 us.
std::size_t resident_memory_bytes(double share_of_common = 1);

/// Memory that the process can take on top of what it holds, bytes: what the machine has available without swapping,
/// or what its control group still allows, whichever is less. The machine's memory where the system reports neither.
std::size_t available_memory_bytes();

}  // namespace exitance

#pragma once

#include <cstddef>

namespace exitance::fuzz {

/// From now on the process ends, with a word about it, when it asks for more than `bytes` at a time. 0: no limit. Sees
/// malloc, so operator new and C libraries alike.
void limit_memory(std::size_t bytes);

/// The most that a copy of the process, which a reader made and waited for, has held resident so far beyond the most
/// that the process itself has, bytes. Copies are not limited by the above: they run as they do for users.
std::size_t most_held_by_copies();

/// The most that was held beyond what was held at the last limit_memory, bytes.
std::size_t most_held();

}  // namespace exitance::fuzz

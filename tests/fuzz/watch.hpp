#pragma once

#include <cstddef>

namespace exitance::fuzz {

/// Ends the process with a message if it requests more than `bytes` of memory at a time; 0: no limit. Replaces malloc,
/// so it includes operator new and C libraries.
void limit_memory(std::size_t bytes);

/// Largest resident size so far of process copies that a reader made and waited for, minus that of the process itself,
/// bytes. limit_memory() does not apply to copies: they run as they do for users.
std::size_t most_held_by_copies();

/// Largest additional memory since the last limit_memory(), bytes.
std::size_t most_held();

}  // namespace exitance::fuzz

#pragma once

#include <cstddef>

namespace exitance::fuzz {

/// From now on the process ends, with a word about it, when it asks for more than `bytes` at a time. 0: no limit. Sees
/// malloc, so operator new and C libraries alike.
void limit_memory(std::size_t bytes);

/// The most that was held beyond what was held at the last limit_memory, bytes.
std::size_t most_held();

}  // namespace exitance::fuzz

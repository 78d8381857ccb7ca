#pragma once

#include <cstddef>

namespace exitance {

/// The most memory the process has held at once so far, bytes (its peak resident set).
std::size_t peak_memory_bytes();

}  // namespace exitance

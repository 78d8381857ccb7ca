#pragma once

#include <cstddef>

namespace exitance {

/// The most memory the process has held at once so far, bytes (its peak resident set).
std::size_t peak_memory_bytes();

/// The memory that the process holds now, bytes: of pages that several processes have in common its even share
/// (proportional set size). 0 where the system does not tell.
std::size_t proportional_memory_bytes();

/// Processor time that the process has taken so far, on all of its threads, seconds.
double processor_seconds();

/// The machine's memory, bytes.
std::size_t machine_memory_bytes();

/// From here on large arrays have pages of their own, which go back to the system as soon as they are freed. To be
/// called once, first of all.
void keep_large_arrays_apart();

/// Gives pages that nothing stands on any more back to the system. To be called between phases.
void release_freed_memory();

}  // namespace exitance

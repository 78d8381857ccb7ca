#pragma once

#include <cstddef>

namespace exitance {

/// Returns the peak resident set size of the process so far, bytes.
std::size_t peak_memory_bytes();

/// Returns the memory that the process holds now (proportional set size), bytes: a page shared by k processes counts
/// 1/k. 0 if the system does not report it.
std::size_t proportional_memory_bytes();

/// Returns the processor time used by all threads of the process so far, seconds.
double processor_seconds();

/// Returns the physical memory of the machine, bytes.
std::size_t machine_memory_bytes();

/// From this call on, large arrays are allocated in pages of their own, which return to the system as soon as the
/// arrays are freed. To be called once, before anything else is allocated.
void keep_large_arrays_apart();

/// Returns unused heap pages to the system. To be called between phases.
void release_freed_memory();

}  // namespace exitance

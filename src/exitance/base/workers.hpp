#pragma once

#include <cstddef>

namespace exitance {

/// Calls work(team, worker) for every worker in [0, count), on as many threads as are free. This is all that parallel
/// loops take of oneTBB; it is compiled without the thread sanitizer, which would report that library's own headers.
/// Plain pointers, since a closure would be read before its thread has said what it comes after.
void run_workers(std::size_t count, void (*work)(void* team, std::size_t worker), void* team);

}  // namespace exitance

#pragma once

#include <cstddef>

namespace exitance {

/// Calls work(team, worker) for every worker in [0, count), on as many threads as are free. This is the only use of
/// oneTBB by parallel loops. It is compiled without the thread sanitizer, which would report the headers of that
/// library. The arguments are plain pointers because the sanitizer would report a closure as read before its thread is
/// synchronised.
void run_workers(std::size_t count, void (*work)(void* team, std::size_t worker), void* team);

}  // namespace exitance

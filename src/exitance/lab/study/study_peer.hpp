#pragma once

#include <mutex>
#include <optional>

#include "exitance/lab/study/study_solve.hpp"

namespace exitance {

/// Runs the row's peer in a process of its own to compute the light of the scene at the points of its reference, and
/// measures its error; or reads an earlier result. `seconds` is the time for light reported by the peer, otherwise that
/// of the process. Returns nothing after a request to stop. If the peer is not installed, the row's status says so.
Result<std::optional<Table>> peer_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop);

}  // namespace exitance

#pragma once

#include <mutex>
#include <optional>

#include "exitance/lab/study/study_solve.hpp"

namespace exitance {

/// Has the row's peer make the light of the scene at the points of its reference, in a process of its own, and measures
/// it; or reads what was found before. `seconds` are what the peer tells of light alone, else those of the process.
/// Nothing where a stop was asked for. A peer that is not there is a row that says so.
Result<std::optional<Table>> peer_for_study(const StudySolve& run, std::mutex& files, const StopRequest& stop);

}  // namespace exitance

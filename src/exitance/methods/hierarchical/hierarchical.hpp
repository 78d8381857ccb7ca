#pragma once

#include <cstddef>

#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Would links between all pieces that see each other, about half of the pairs, take more than `--memory-limit`?
bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options);

/// Does what was asked for say how links are to be found or judged, or deliver what they hold?
bool asks_for_judged_links(const SolveOptions& options);

}  // namespace exitance

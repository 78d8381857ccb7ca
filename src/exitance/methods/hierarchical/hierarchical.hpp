#pragma once

#include <cstddef>

#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// True if links between all pieces that see each other (about half of the pairs) would exceed `--memory-limit`.
bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options);

/// True if an option determines how links are found or judged, or requires the links' own light.
bool asks_for_judged_links(const SolveOptions& options);

}  // namespace exitance

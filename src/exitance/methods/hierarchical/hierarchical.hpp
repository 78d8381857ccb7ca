#pragma once

#include <cstddef>

#include "exitance/solve/solve_options.hpp"

namespace exitance {

/// Would links between all pieces that see each other, about half of the pairs, take more than `--memory-limit`?
bool links_outgrow_memory(std::size_t pieces, const SolveOptions& options);

}  // namespace exitance

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace exitance {

/// The candidate that is most similar to `word`: fewest letters inserted, dropped, changed or swapped with their
/// neighbour, at most a third of the longer word's; empty when none is that near. O(candidates * letters^2).
std::string nearest(std::string_view word, std::span<const std::string> candidates);

}  // namespace exitance

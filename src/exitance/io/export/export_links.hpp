#pragma once

#include <string>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Writes links of a solution that holds them, for teaching. `which`: an element's number, for the links to it; or
/// "x,y,z" (metres), for those to the leaf nearest to that place and to all elements that it is part of, which together
/// bring all of its light. By ending: `.csv`, a row a link; `.obj`, the elements' outlines as polygons and a line from
/// the middle of each source to the receiver's. Docs: formats.md.
Result<void> export_links(const Solution& solution, const std::string& which, const std::string& path);

}  // namespace exitance

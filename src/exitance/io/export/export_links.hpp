#pragma once

#include <string>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Writes links of a solution that stores them, for teaching.
/// which  an element's number: the links to it; or "x,y,z" (metres): the links to the nearest leaf and all its
/// ancestors, which together carry all of its reflected light
/// path   `.csv`: one row per link; `.obj`: outlines of the elements as polygons, and a line from the centre of each
/// source to that of the receiver
/// Format: docs/formats/exports.md.
Result<void> export_links(const Solution& solution, const std::string& which, const std::string& path);

}  // namespace exitance

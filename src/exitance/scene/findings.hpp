#pragma once

#include <span>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Sorts errors first, then by file and line.
void sort_findings(std::vector<Finding>& findings);

/// True if there is an error among the findings.
bool has_errors(std::span<const Finding> findings);

/// Returns the first error among findings that contain one, as the reason why there is no scene. The message gives the
/// number of further errors.
Error error_of(std::span<const Finding> findings);

/// Returns "room.obj:41", or "room.obj" without a line.
std::string place_of(const Finding& finding);

}  // namespace exitance

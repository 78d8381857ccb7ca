#pragma once

#include <span>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Puts errors first, then orders by file and line.
void sort_findings(std::vector<Finding>& findings);

/// Is there an error among them?
bool has_errors(std::span<const Finding> findings);

/// The first error among findings that hold one, as the reason why there is no scene; says how many more there are.
Error error_of(std::span<const Finding> findings);

/// "room.obj:41", "room.obj" without a line.
std::string place_of(const Finding& finding);

}  // namespace exitance

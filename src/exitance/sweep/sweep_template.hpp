#pragma once

#include <set>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/sweep/sweep_plan.hpp"

namespace exitance {

/// Replaces the placeholders "{{name}}" in `content`, the text of the template `path`, by the values of a variant.
/// Blanks around the name are ignored. Error: bad_input, with the line of the template, for an unknown name and for
/// "{{" without "}}" in its line.
Result<std::string> fill_in_template(const SweepPlan& plan, const SweepSetting& variant, const std::string& path,
                                     const std::string& content);
/// Names of the placeholders in a template.
std::set<std::string> names_in_template(const std::string& content);

}  // namespace exitance

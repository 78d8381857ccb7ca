#pragma once

#include "exitance/cli/option_kinds.hpp"

namespace exitance {

/// Options of `report` that lighting standards ask for: --plane, --cylindrical, --maintenance, --observers, --tables.
void declare_standards(CLI::App& app, ReportArguments& arguments);

/// Who observers named by words are: "auto", "x,y,z dx,dy,dz", or a table (CSV x,y,z,dx,dy,dz).
Result<std::vector<Observer>> find_observers(const std::string& words, const Scene& scene);

}  // namespace exitance

#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/glare/glare.hpp"

namespace exitance {

/// Who observers named by words are: "auto", "x,y,z dx,dy,dz", or a table (CSV x,y,z,dx,dy,dz).
Result<std::vector<Observer>> find_observers(const std::string& words, const Scene& scene);

}  // namespace exitance

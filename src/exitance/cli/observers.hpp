#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/glare/glare.hpp"

namespace exitance {

/// Observers for glare. `words`: "auto" for one in the middle of each wall, "x,y,z dx,dy,dz" for eye and line of sight,
/// or the name of a table (CSV x,y,z,dx,dy,dz), in metres. Error: words or rows that describe no observer.
Result<std::vector<Observer>> find_observers(const std::string& words, const Scene& scene);

/// Reads a table of views (CSV x,y,z,dx,dy,dz, metres). Rows without a direction are eight views each, every 45 degrees
/// around the horizon.
Result<std::vector<Observer>> load_views(const std::string& path);

/// Returns the observers of all words, in order.
Result<std::vector<Observer>> find_observers(const std::vector<std::string>& all, const Scene& scene);

}  // namespace exitance

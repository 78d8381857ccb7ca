#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/glare/glare.hpp"

namespace exitance {

class FloorRooms;

/// Observers for glare. `words`: "auto" for room_observers(), "x,y,z dx,dy,dz" for eye and line of sight,
/// or the name of a table (CSV x,y,z,dx,dy,dz or x,y,z,nx,ny,nz, metres, or a Honeybee model with its views). Error:
/// words or rows that describe no observer.
Result<std::vector<Observer>> find_observers(const std::string& words, const Stage& stage, const FloorRooms& rooms);

/// Reads a table of views (CSV x,y,z,dx,dy,dz or x,y,z,nx,ny,nz, metres) or those of a Honeybee model. Rows without a
/// direction are eight views each, every 45 degrees around the horizon.
Result<std::vector<Observer>> load_views(const std::string& path);

/// Returns the observers of all words, in order.
Result<std::vector<Observer>> find_observers(const std::vector<std::string>& all, const Stage& stage,
                                             const FloorRooms& rooms);

/// True if the rooms of the scene are needed to place these observers.
bool need_rooms(const std::vector<std::string>& observers);

}  // namespace exitance

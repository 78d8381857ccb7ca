#pragma once

#include <string>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Writes the interpolant of a solution for other programs, in the format of the path's ending:
/// .vtkhdf, .vtu   elements with radiosity and irradiance, for ParaView
/// .glb            triangles with light as vertex attributes, glTF 2.0
/// .obj            polygons with display colours at the vertices, and a .mtl beside it
/// .csv            a table of the input's faces with their mean light
/// Files appear whole or not at all. Another ending is an error (ErrorCode::usage).
Result<void> export_solution(const Solution& solution, const std::string& path);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// HDF5 after VTK's layout: the group /VTKHDF of a solution's file alone.
Result<void> write_vtkhdf_file(const Solution& solution, const std::string& path);

/// VTK's XML UnstructuredGrid, its arrays in base64.
/// Discontinuity curves as a table, a stretch a line.
Result<void> write_curves(const Solution& solution, const std::string& path);

Result<void> write_vtu(const Solution& solution, const std::string& path);

/// Wavefront OBJ: a polygon a leaf, in groups and materials as the scene has them; red, green and blue (sRGB, toned)
/// after each vertex. The materials go to a file of the same name ending in .mtl.
Result<void> write_obj(const Solution& solution, const std::string& path);

/// A row a face of the input, in its order: surface,line,group,material,area,E_*,B_* (means over the face),
/// relative_error, error_points (empty where no error was measured; 0 points: the error is that of the face's room).
Result<void> write_surface_table(const Solution& solution, const std::string& path);

/// Binary glTF 2.0: triangles, Y up, metres. Vertex attributes: _RADIOSITY and _IRRADIANCE (W/m^2, float), COLOR_0 the
/// toned irradiance, so that base colour (the reflectance) times COLOR_0 shows the reflected light. Materials that only
/// reflect are unlit: they show that as it is; the others emit with KHR_materials_emissive_strength (W/(m^2 sr)).
Result<void> write_glb(const Solution& solution, const std::string& path);

}  // namespace exitance

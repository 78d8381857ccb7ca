#pragma once

#include <string>

#include "exitance/solution/solution.hpp"

namespace exitance {

/// Writes only the group /VTKHDF of a solution file, HDF5 in VTK's layout.
Result<void> write_vtkhdf_file(const Solution& solution, const std::string& path);

/// Writes discontinuity curves as a table, one segment per line.
Result<void> write_curves(const Solution& solution, const std::string& path);

/// Writes VTK's XML UnstructuredGrid with base64 arrays.
Result<void> write_vtu(const Solution& solution, const std::string& path);

/// Writes Wavefront OBJ: one polygon per leaf, in the groups and materials of the scene, with red, green and blue
/// (sRGB, tone mapped) after each vertex. The materials are in a file of the same name with the ending .mtl.
Result<void> write_obj(const Solution& solution, const std::string& path);

/// Writes one row per input face, in input order: surface,line,group,material,area,E_*,B_* (means over the face),
/// relative_error, error_points (empty if no error was measured; 0 points: the error is that of the face's room).
Result<void> write_surface_table(const Solution& solution, const std::string& path);

/// Writes binary glTF 2.0: triangles, Y up, metres. The vertex attributes are _RADIOSITY and _IRRADIANCE (W/m^2, float)
/// and the tone-mapped irradiance COLOR_0. Base colour (the reflectance) times COLOR_0 is the reflected light, which
/// unlit materials show without shading. Materials that emit have KHR_materials_emissive_strength (W/(m^2 sr)) in place
/// of being unlit.
Result<void> write_glb(const Solution& solution, const std::string& path);

}  // namespace exitance

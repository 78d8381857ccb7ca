#pragma once

#include <string>

#include "exitance/reconstruct/pictures/camera.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"

namespace exitance {

/// What the viewer's page draws: elements with irradiance at their corners.
enum class ViewerLayer {
    exported,  ///< The elements that `export` writes, with all light.
    method,    ///< The method's own, with reflected light.
};

/// How many leaves one part of a layer holds at most: a page can draw the first before the last has come.
constexpr std::size_t viewer_part_leaves = 65536;

/// How many parts a layer has; at least one.
std::size_t viewer_part_count(const Solution& solution, ViewerLayer layer);

/// One part of a layer, little-endian: the letters EXV1, then the counts v of vertices, t of triangles and e of edges
/// (uint32), then positions (3 v float32, metres), irradiance (3 v float32, W/m^2), materials (v uint32), numbers of
/// elements (v uint32), corners of triangles (3 t uint32), ends of edges (2 e uint32) and their orders of discontinuity
/// (e uint32; 255 where there is none). O(leaves of the solution).
std::string viewer_part(const Solution& solution, ViewerLayer layer, std::size_t part);

/// Facts about a solution as JSON: `file, photometric, surfaces, materials [{name, reflectance, exitance}], exposure,
/// camera {eye, target, fov}, box, parts {exported, method}, error, links`.
std::string viewer_scene_json(const RadiosityFunction& light, const Camera& camera);

/// Light at a point of a surface as JSON: `irradiance, radiosity, direct, indirect` (W/m^2 a band), `surface, line,
/// group, material, element, links [{outline, form_factor}]`, of the latter the strongest `most_links`.
std::string viewer_point_json(const RadiosityFunction& light, const ProbePoint& point);

/// Irradiance (mean of the bands) at `count` points from one to another, measured in the plane with normal n:
/// `length, values`.
std::string viewer_line_json(const RadiosityFunction& light, const Point& from, const Point& to, const Normal& n,
                             std::size_t count);

}  // namespace exitance

#pragma once

#include <string>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/pictures/camera.hpp"

namespace exitance {

/// Facts about a solution as JSON: `file, photometric, weights [3] (of red, green, blue in one number), surfaces,
/// materials [{name, reflectance, exitance}], exposure, camera {eye, target, fov}, box, parts {exported, method, raw},
/// basis, groups [name], shadow_classes, discontinuities, error, links`.
std::string viewer_scene_json(const Solution& solution, const Camera& camera);

/// Light at a point of a surface as JSON: `irradiance, radiosity, direct, indirect` (W/m^2 a band), `surface, line,
/// group, material, element, links [{outline, form_factor}]`, of the latter the strongest `most_links`.
std::string viewer_point_json(const RadiosityFunction& light, const ProbePoint& point);

/// Irradiance (all bands as one number in the scene's unit) at `count` points from one to another, measured in the
/// plane with normal n: `length, values` (what `probe` evaluates), `delivered` (what `export` writes), `raw` (the
/// method's own elements).
std::string viewer_line_json(const RadiosityFunction& light, const Point& from, const Point& to, const Normal& n,
                             std::size_t count);

}  // namespace exitance

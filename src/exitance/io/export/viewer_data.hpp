#pragma once

#include <string>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

/// Formats facts about a solution as JSON: `file, lux, weights [3] (of red, green, blue in one number of `unit`),
/// surfaces, materials [{name, reflectance, exitance}], exposure, camera {eye, target, fov}, box, parts {exported,
/// method, raw}, basis, groups [name], shadow_classes, discontinuities, error, links`.
std::string viewer_scene_json(const Solution& solution, const Camera& camera, const LightUnit& unit);

/// Formats the light at a surface point as JSON: `irradiance, radiosity, direct, indirect` (W/m^2 per band), `surface,
/// line, group, material, element, links [{outline, form_factor}]`. Only the strongest `max_links` links are included.
std::string viewer_point_json(const RadiosityFunction& light, const ProbePoint& point);

/// Formats irradiance at `count` points on the line between two points, in a plane with normal `n`, as JSON, with all
/// bands as one number in `unit`: `length, values` (as `probe` evaluates it), `delivered` (as `export` writes
/// it), `raw` (in the method's own elements).
std::string viewer_line_json(const RadiosityFunction& light, const Point& from, const Point& to, const Normal& n,
                             std::size_t count, const LightUnit& unit);

}  // namespace exitance

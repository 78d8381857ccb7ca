#pragma once

#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {

/// Light maps of what surfaces reflect, rho E in W/m^2: `irradiance` of the maps returned. Where a surface has a
/// texture rho follows it, such that its mean over the picture is the reflectance that the light was computed with (at
/// most 0.95); a texel holds the mean over the part of it that lies on its face. Elsewhere rho is the material's.
LightMaps reflected_maps(const Scene& scene, const LightMaps& light, const SceneTextures* textures);

}  // namespace exitance

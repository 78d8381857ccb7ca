#pragma once

#include "exitance/io/scenes/textures/scene_textures.hpp"
#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {

/// Computes light maps of reflected light, rho E in W/m^2, which the returned maps store as `irradiance`. On textured
/// surfaces rho follows the texture, scaled so that its mean over the picture is the reflectance used in the solution
/// (rho is at most 0.95). A texel has the mean over its part on the face. Without a texture, rho is the material's.
LightMaps reflected_maps(const Scene& scene, const LightMaps& light, const SceneTextures* textures);

}  // namespace exitance

#pragma once

#include <span>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Directions of rays that sample the irradiance E_met of a region, from two numbers in [0, 1) each: density cos / pi
/// about the normal n (`cosine_directions`). For a diffusing pane, the share `Material::through` of the directions goes
/// to the other side, so that their mean is E_met. `own` may be none.
void met_directions(const Scene& scene, RegionId own, const Normal& n, std::span<const double> a,
                    std::span<const double> b, std::span<Vec3> directions);
Vec3 met_direction(const Scene& scene, RegionId own, const Normal& n, double a, double b);

}  // namespace exitance

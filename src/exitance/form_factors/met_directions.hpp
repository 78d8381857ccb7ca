#pragma once

#include <span>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Directions of rays that find what a place of a region meets, by two numbers in [0, 1) each: density cos / pi about
/// its normal n (`cosine_directions`). Of a diffusing pane so many of them as `Material::through` says leave by the
/// other side, so that their mean is E_met. `own` may be none.
void met_directions(const Scene& scene, RegionId own, const Normal& n, std::span<const double> a,
                    std::span<const double> b, std::span<Vec3> directions);
Vec3 met_direction(const Scene& scene, RegionId own, const Normal& n, double a, double b);

}  // namespace exitance

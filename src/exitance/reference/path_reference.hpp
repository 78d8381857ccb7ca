#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Unbiased estimate of the irradiance at a point.
struct ReferenceLight {
    Spectrum irradiance;  ///< W/m^2
    /// Standard error of `irradiance`, from 16 independent randomisations; itself uncertain by about 18%. Includes that
    /// of direct light.
    Spectrum standard_error;
    SurfaceId surface;              ///< The face at the point; none in free space.
    bool is_between_sides = false;  ///< See Light::is_between_sides.
};

/// Estimates irradiance at points (at the places that a PlaceFinder finds for them) without a mesh: E(x) = E_dir(x),
/// exact or, where that is more expensive than the paths, by as many rays, plus the mean over paths of the light that
/// reaches x after at least one reflection. At every vertex of a path, the direct light is estimated by one shadow ray,
/// to an emitter chosen by its unoccluded contribution, and by the path's next ray, weighted by the balance heuristic.
/// Paths end by Russian roulette, with the reflectance as survival probability. `paths`: number of paths per point,
/// rounded up to a multiple of 16. Deterministic for a given `seed` and index of a point. After a stop request, the
/// result ends before the first unfinished point. Several processes divide the points. Collective. Source: [Kajiya86],
/// [Veach95]. O(points x paths).
std::vector<ReferenceLight> reference_light(const Scene& scene, std::span<const ProbePoint> points, std::size_t paths,
                                            std::uint64_t seed, Progress& progress, const StopRequest& stop);

}  // namespace exitance

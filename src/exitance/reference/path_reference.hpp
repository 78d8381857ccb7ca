#pragma once

#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// An unbiased estimate of the irradiance at a point.
struct ReferenceLight {
    Spectrum irradiance;      ///< W/m^2
    Spectrum standard_error;  ///< Of `irradiance`, from 16 independent randomisations; itself uncertain by some 18%.
    SurfaceId surface;        ///< The face that the point lies on; none in free space.
    bool is_between_sides = false;  ///< As that of Light.
};

/// Irradiance at points (at the places that a PlaceFinder finds for them) without any mesh: E(x) = E_dir(x), exact,
/// plus the mean over paths of what reaches x after one reflection or more. Light of emitters and skies that panes
/// mirror is left out (mirrored_light.hpp). At every vertex of a path the direct light is estimated by one shadow ray,
/// to an emitter chosen by its unoccluded contribution, and by the path's next ray, weighted by the balance heuristic;
/// paths end by Russian roulette with the reflectance as survival. `paths` is rounded up to a multiple of 16.
/// Deterministic by `seed` and a point's place in `points`. After a stop the result ends before the first point that is
/// not finished. Source: [Kajiya86], [Veach95]. O(points x paths).
std::vector<ReferenceLight> reference_light(const Scene& scene, std::span<const ProbePoint> points, std::size_t paths,
                                            std::uint64_t seed, Progress& progress, const StopRequest& stop);

}  // namespace exitance

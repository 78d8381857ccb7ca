#pragma once

#include "exitance/measure/pictures/picture.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// Surfaces that a camera sees through the centres of its pixels: points on fronts, and the pixels that show them.
struct SeenPlaces {
    PictureSize size;
    std::vector<ProbePoint> points;
    std::vector<RegionId> regions;
    std::vector<std::size_t> pixels;
};
SeenPlaces seen_places(const Scene& scene, const RayTracer& tracer, const Camera& camera, PictureSize size);

/// Irradiance of a reference at the nearest of its points on the same region, W/m^2; NaN if there is none. O(places x
/// points of a region).
std::vector<Spectrum> nearest_reference(const SeenPlaces& places, const ReferencePoints& reference, const Scene& scene);

/// Returns a picture whose irradiance is |E - E_ref|, W/m^2, at the places. Pixels whose reference is NaN are empty.
Picture error_picture(const SeenPlaces& places, const std::vector<Spectrum>& irradiance,
                      const std::vector<Spectrum>& reference);

}  // namespace exitance

#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Light of the full function at points spread over one input face, without covered points.
struct SurfacePoints {
    SurfaceId surface;
    std::vector<Light> light;  ///< Light at the points; empty if the whole face is covered.
};

/// Measures the light of faces at about `total` points in all, in proportion to their areas, but at least 16 and at
/// most 1024 per face. A face's points are stratified by area. After a stop request the remaining faces have no values.
std::vector<SurfacePoints> measure_surfaces(const RadiosityFunction& light, std::span<const SurfaceId> faces,
                                            std::size_t total, Progress& progress, const StopRequest& stop);

}  // namespace exitance

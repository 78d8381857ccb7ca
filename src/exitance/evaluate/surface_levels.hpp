#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Light of the full function at points spread over one face of the input, as far as they lie in the open.
struct SurfacePoints {
    SurfaceId surface;
    std::vector<Light> light;  ///< Empty where all of the face is covered.
};

/// Measures faces at `total` points altogether, in proportion to their areas, but at least 16 and at most 1024 a face;
/// a face's points are stratified in area. After a stop the rest is left out.
std::vector<SurfacePoints> measure_surfaces(const RadiosityFunction& light, std::span<const SurfaceId> faces,
                                            std::size_t total, Progress& progress, const StopRequest& stop);

}  // namespace exitance

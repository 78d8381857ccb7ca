#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Light in one pixel, as the mean over its samples that meet a surface's front.
struct Pixel {
    Spectrum radiosity;    ///< B, W/m^2; the radiance is B / pi.
    Spectrum irradiance;   ///< E, W/m^2
    Spectrum from_lamps;   ///< B of the samples that meet emitters, mean over these, W/m^2.
    float front = 0;       ///< Share of the samples that meet a front.
    float emitting = 0;    ///< Share that meet an emitter's front.
    float back = 0;        ///< Share that meet a back; what is left meets nothing.
    RegionId region = {};  ///< What every sample meets the front of; none if they differ.

    bool emits() const { return emitting > 0; }
};

/// Rows from top to bottom.
struct Picture {
    PictureSize size;
    std::vector<Pixel> pixels;
};

struct PictureOptions {
    Camera camera;
    PictureSize size;
    int samples = 4;      ///< Rays a pixel.
    unsigned gather = 0;  ///< Rays of a final gather at every sample, a power of two from 4; 0: read the solution.
    std::uint64_t seed = 1;
};

/// What a camera sees of a solution, `samples` rays a pixel, spread with the density of a tent two pixels wide (so that
/// the picture is filtered by it) and by a low-discrepancy sequence, the same in every pixel.
///
/// What is seen is the function that `probe` evaluates: exact direct light, indirect light from the elements. The
/// picture is cut into blocks; on the part of a region that shows in one, a shaft tells which emitters are all in view
/// there, certainly hidden, or have something in between (DirectLight::prepare). Where nothing is in between, light is
/// smooth, and one evaluation serves a pixel as long as it looks small from the emitters. Elsewhere it serves a pixel
/// that differs from none of its neighbours by more than a hundredth; of the others four samples are evaluated, and if
/// these differ by more than a hundredth, all. Where something stands before more than 24 emitters, rays find their
/// light (SharedRays) to 0.4% of what the pixel or a quarter of the median pixel shows, and it is interpolated where it
/// is even. The same bits on any number of threads. A stop leaves the rest of the picture empty. About 0.1 us a sample
/// and 1-2 us a pixel and emitter that something stands before.
Picture take_picture(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                     const StopRequest& stop);

/// Marks the pixels at which one element of a tree over the scene's regions ends and the next one begins.
std::vector<bool> element_edges(const ElementTree& tree, const Scene& scene, const RayTracer& tracer,
                                const Camera& camera, PictureSize size);

}  // namespace exitance

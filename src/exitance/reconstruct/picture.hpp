#pragma once

#include <vector>

#include "exitance/reconstruct/camera.hpp"
#include "exitance/reconstruct/radiosity_function.hpp"

namespace exitance {

/// Light in one pixel, as the mean over its samples that meet a surface's front.
struct Pixel {
    Spectrum radiosity;   ///< B, W/m^2; the radiance is B / pi.
    Spectrum irradiance;  ///< E, W/m^2
    float front = 0;      ///< Share of the samples that meet a front.
    float back = 0;       ///< Share that meet a back; what is left meets nothing.
    bool emits = false;   ///< Does any sample meet an emitter?
};

/// Rows from top to bottom.
struct Picture {
    PictureSize size;
    std::vector<Pixel> pixels;
};

/// What a camera sees of a solution, `samples` rays a pixel at the same well-spread places of each. Light is evaluated
/// for every fourth of a pixel's hits on one region: edges of things are smooth at four samples, edges of hard shadows
/// at sixteen. The same bits on any number of threads. About 5 us an evaluation and visible emitter.
Picture take_picture(const Scene& scene, const RadiosityFunction& light, const RayTracer& tracer, const Camera& camera,
                     PictureSize size, int samples);

/// Marks the pixels at which one element of the solution's interpolant ends and the next one begins.
std::vector<bool> element_edges(const Solution& solution, const RayTracer& tracer, const Camera& camera, PictureSize size);

}  // namespace exitance

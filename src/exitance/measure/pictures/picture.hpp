#pragma once

#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Light of one pixel: the mean over its samples that hit the front of a surface.
struct Pixel {
    Spectrum radiosity;    ///< B, W/m^2; the radiance is B / pi.
    Spectrum irradiance;   ///< E, W/m^2
    Spectrum from_lamps;   ///< Mean B over the samples that hit emitters, W/m^2.
    float front = 0;       ///< Share of the samples that hit a front.
    float emitting = 0;    ///< Share that hit an emitter's front.
    float back = 0;        ///< Share that hit a back; the remaining samples hit nothing.
    RegionId region = {};  ///< Region whose front every sample hits; none if they differ.

    bool emits() const { return emitting > 0; }
};

/// A picture. Rows from top to bottom.
struct Picture {
    PictureSize size;
    std::vector<Pixel> pixels;
};

struct PictureOptions {
    Camera camera;
    PictureSize size;
    int samples = 4;  ///< Rays per pixel.
    /// Rays of a final gather at every sample, a power of two of at least 4; 0: read the solution.
    unsigned gather = 0;
    std::uint64_t seed = 1;
    /// Relative difference below which light without shadow edges may be interpolated between pixels, for pictures that
    /// are viewed, not measured; 0: the light of every pixel is evaluated.
    double interpolation = 0;
};

/// Renders a solution with `samples` rays per pixel. The rays have the density of a tent filter two pixels wide (so
/// that the picture is filtered by it) and follow a low-discrepancy sequence, the same in every pixel.
///
/// Shows the function that `probe` evaluates: exact direct light, and indirect light from the elements. The picture is
/// divided into blocks. For the part of a region that is visible in a block, a shaft finds the emitters that are fully
/// visible, certainly hidden, or possibly blocked (DirectLight::prepare). Without possible blockers light is smooth,
/// and one evaluation is used for a pixel as long as it is small as seen from the emitters. Otherwise one is used for a
/// pixel that differs from none of its neighbours by more than a hundredth. In other pixels four samples are evaluated,
/// and all samples if these differ by more than a hundredth. If more than 24 emitters may be blocked, rays estimate
/// their light (SharedRays) to 0.4% of the light of the pixel or of a quarter of the median pixel, and it is
/// interpolated where it is uniform. Same bits on any number of threads. Several processes divide the tiles, and all
/// get the picture. After a stop request the rest of the picture is empty. Collective. About 0.1 us per sample, and 1-2
/// us per pixel and possibly blocked emitter.
Picture take_picture(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                     const StopRequest& stop);

/// Marks the pixels at the borders between elements of a tree over the scene's regions.
std::vector<bool> element_edges(const ElementTree& tree, const Scene& scene, const RayTracer& tracer,
                                const Camera& camera, PictureSize size);

}  // namespace exitance

#pragma once

#include "exitance/base/parallel.hpp"
#include "exitance/measure/pictures/camera.hpp"
#include "exitance/visibility/rays.hpp"

namespace exitance {

/// Calls visit(pixel, hit, point) for every pixel in whose centre the front of a surface is visible. Pixels are
/// numbered row by row from the top; `point` is the point of the surface, metres. Parallel: calls for different pixels
/// must not depend on each other.
template <class Visit>
void for_visible_fronts(const RayTracer& tracer, const Camera& camera, PictureSize size, const Visit& visit) {
    const CameraRays rays(camera, size);
    const auto width = static_cast<std::size_t>(size.width);
    parallel_for(static_cast<std::size_t>(size.height), 4, [&](std::size_t y) {
        for (std::size_t x = 0; x < width; ++x) {
            Point origin;
            Vec3 direction;
            RayHit hit;
            if (!rays.ray(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, origin, direction)) continue;
            tracer.nearest(std::span(&direction, 1), origin, RegionId(), std::span(&hit, 1));
            if (!hit.surface.is_none() && hit.front) visit(y * width + x, hit, origin + hit.distance * direction);
        }
    });
}

}  // namespace exitance

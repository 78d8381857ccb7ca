#pragma once

#include "exitance/scene/scene.hpp"
#include "exitance/transport/visibility.hpp"

namespace exitance {

/// Width and height in pixels.
struct PictureSize {
    int width = 640, height = 400;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// A pinhole: what stands upright in space (along Z) stands upright in the picture.
struct Camera {
    Point eye, target;
    double fov = 60;  ///< Angle from the left to the right edge, degrees, in (0, 180).
};

/// The directions in which a camera looks.
class CameraRays {
  public:
    CameraRays(const Camera& camera, PictureSize size);

    /// Through (x, y) in pixels from the upper left corner; not of length 1.
    Vec3 direction(double x, double y) const { return corner_ + x * right_ + y * down_; }

  private:
    Vec3 corner_, right_, down_;
};

/// A camera that shows a scene well: in a closed room near the corner from which most of it is in view; else outside,
/// on the side that shows most fronts, with the whole scene in the picture. Traces some thousand rays.
Camera automatic_camera(const Scene& scene, const RayTracer& tracer, PictureSize size);

}  // namespace exitance

#pragma once

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Width and height in pixels.
struct PictureSize {
    int width = 640, height = 400;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// How directions become places in a picture.
enum class Projection : std::uint8_t {
    perspective,   ///< A pinhole: straight lines stay straight.
    orthographic,  ///< Rays are parallel: lengths across the view keep their scale.
    fisheye,       ///< A disc in which the distance from the middle is the angle from the axis (equidistant).
    panorama,      ///< All around: longitude to the right, the zenith on top (equirectangular, 360 x 180 degrees).
};

/// What stands upright in space (along `up`) stands upright in the picture.
struct Camera {
    Point eye, target;
    /// From the left to the right edge: degrees in (0, 180); fisheye: across the disc, degrees in (0, 360];
    /// orthographic: metres; panorama: unused.
    double fov = 60;
    Vec3 up = {0, 0, 1};  ///< Along the line of sight it means nothing: then Y is up.
    Projection projection = Projection::perspective;
};

/// The rays that a camera sees along.
class CameraRays {
  public:
    CameraRays(const Camera& camera, PictureSize size);

    /// The ray through (x, y), in pixels from the upper left corner; its direction has any length. False where the
    /// picture shows nothing: outside the disc of a fisheye, and beyond a panorama's poles.
    bool ray(double x, double y, Point& origin, Vec3& direction) const;

  private:
    Projection projection_;
    PictureSize size_;
    Point eye_;
    Vec3 ahead_, right_, down_;  ///< Of length 1.
    double pixel_ = 0;           ///< At distance 1 from the eye, or metres; of a fisheye radians.
};

}  // namespace exitance

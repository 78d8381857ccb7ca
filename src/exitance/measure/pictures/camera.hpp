#pragma once

#include <optional>
#include <string>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// Width and height in pixels.
struct PictureSize {
    int width = 640, height = 400;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Mapping of directions to positions in a picture.
enum class Projection : std::uint8_t {
    perspective,   ///< Pinhole camera: straight lines stay straight.
    orthographic,  ///< Parallel rays: lengths perpendicular to the view keep their scale.
    /// A disc in which the distance from the centre is proportional to the angle from the axis (equidistant).
    fisheye,
    panorama,  ///< All directions: longitude to the right, the zenith on top (equirectangular, 360 x 180 degrees).
};

/// A camera. The direction `up` is vertical in the picture.
struct Camera {
    Point eye, target;
    /// Field of view from the left to the right edge, degrees in (0, 180); fisheye: across the disc, degrees in (0,
    /// 360]; orthographic: width in metres; panorama: unused.
    double fov = 60;
    Vec3 up = {0, 0, 1};  ///< Upward direction. Y is used instead if it is parallel to the line of sight.
    Projection projection = Projection::perspective;
};

/// Returns what is wrong with a camera, as a sentence; none if pictures can be made with it.
std::optional<std::string> find_fault(const Camera& camera);

/// Generates the rays of a camera.
class CameraRays {
  public:
    CameraRays(const Camera& camera, PictureSize size);

    /// Returns the ray through (x, y), in pixels from the upper left corner; its direction is not normalized. Returns
    /// false outside the picture: outside the disc of a fisheye, and beyond a panorama's poles.
    bool ray(double x, double y, Point& origin, Vec3& direction) const;

  private:
    Projection projection_;
    PictureSize size_;
    Point eye_;
    Vec3 ahead_, right_, down_;  ///< Unit vectors.
    /// Width of a pixel at distance 1 from the eye; orthographic: metres; fisheye and panorama: radians.
    double pixel_ = 0;
};

}  // namespace exitance

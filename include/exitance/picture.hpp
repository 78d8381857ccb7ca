#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exitance/solution.hpp"

namespace exitance::api {

enum class Projection {
    perspective,   ///< Pinhole camera.
    orthographic,  ///< Parallel rays.
    fisheye,       ///< Disc; the distance from its centre is proportional to the angle from the axis.
    panorama,      ///< All directions, 360 x 180 degrees, zenith on top.
};

/// A camera: its place, its target, its projection and its angle of view.
struct Camera {
    Vec3 eye, target;  ///< Metres.
    /// Degrees from the left to the right edge; fisheye: across the disc; orthographic: metres; panorama: unused.
    double fov = 60;
    /// Vertical direction in the picture. The y axis is used instead if it is parallel to the line of sight.
    Vec3 up = {0, 0, 1};
    Projection projection = Projection::perspective;
};

/// Checks that pictures can be made with a camera.
/// Error (usage): a number is not finite, the eye is the target, `up` is zero, or `fov` is out of range: above 0, for
/// perspective at most 170 degrees, for fisheye at most 360 degrees.
Result<void> check_camera(const Camera& camera);

/// Options of a picture.
struct PictureOptions {
    std::optional<Camera> camera = {};  ///< None: a view that shows the scene well is chosen.
    int width = 640, height = 400;      ///< Pixels.
    int samples = 16;                   ///< Rays per pixel.
};

struct PictureData;

/// A picture of a solution. Rows from top to bottom. Copies share their data.
class Picture {
  public:
    int width() const;
    int height() const;
    const Camera& camera() const;
    /// Radiance of every pixel, W/(m^2 sr) (cd/m^2 if the scene is photometric); 0 where nothing is visible.
    std::vector<std::array<float, bands>> radiance() const;
    /// Irradiance of the surface in every pixel, W/m^2 (lx); 0 where nothing is visible.
    std::vector<std::array<float, bands>> irradiance() const;
    /// The picture for display, sRGB. exposure  stops above the automatic exposure
    std::vector<std::array<std::uint8_t, 3>> display(double exposure = 0) const;
    /// Writes the picture: .png for display, .exr or .hdr with radiance. `exposure` applies to .png only. The file
    /// appears whole or not at all. Errors: usage, cannot_write.
    Result<void> save(const std::string& path, double exposure = 0) const;

    /// For the library.
    explicit Picture(std::shared_ptr<const PictureData> data) : data_(std::move(data)) {}

  private:
    std::shared_ptr<const PictureData> data_;
};

/// Renders a solution: exact direct light, and reflected light from the elements. About 0.1 us per sample, and 2 us per
/// pixel and emitter that may be hidden. Same bits on any number of threads.
/// Errors: usage for sizes or samples out of range, or as check_camera(); limit after a stop.
Result<Picture> render(const Solution& solution, const PictureOptions& options = {}, const Control& control = {});

}  // namespace exitance::api

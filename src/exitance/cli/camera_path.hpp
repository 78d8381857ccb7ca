#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/pictures/camera.hpp"

namespace exitance {

/// A camera at a time, seconds.
struct CameraStation {
    double time = 0;
    Camera camera;
};

/// The rows `time,ex,ey,ez,tx,ty,tz,fov` of a file; a first row that begins with "time" is a heading.
Result<std::vector<CameraStation>> load_camera_path(const std::string& file);

/// Cameras at equal intervals of 1 / rate seconds, from the first station to the last, in straight lines between them.
/// Times must not fall. At most `most` cameras; none where there would be more.
std::vector<Camera> at_equal_times(const std::vector<CameraStation>& stations, double rate, std::size_t most);

}  // namespace exitance

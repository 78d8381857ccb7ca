#pragma once

#include <string>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/measure/pictures/camera.hpp"

namespace exitance {

/// A camera and its time in seconds.
struct CameraStation {
    double time = 0;
    Camera camera;
};

/// Reads the rows `time,ex,ey,ez,tx,ty,tz,fov` of a file. A first row that begins with "time" is a heading. Error
/// (bad_input): no row, or a row that is not a camera or has a fault (find_fault).
Result<std::vector<CameraStation>> load_camera_path(const std::string& file);

/// Interpolates linearly between stations: one camera every 1 / rate seconds from the first station to the last. Times
/// must not decrease. Returns no camera if there would be more than `most`.
std::vector<Camera> at_equal_times(const std::vector<CameraStation>& stations, double rate, std::size_t most);

}  // namespace exitance

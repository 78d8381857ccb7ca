#include "exitance/cli/camera_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {

Result<std::vector<CameraStation>> load_camera_path(const std::string& file) {
    const Result<std::string> text = read_whole_file(file);
    if (!text) return text.error();
    std::istringstream in(*text);
    std::vector<CameraStation> stations;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty() || (number == 1 && line.starts_with("time"))) continue;
        double n[8] = {};
        const char *at = line.data(), *const end = at + line.size();
        std::size_t count = 0;
        for (; count < 8; ++count) {
            const auto [next, failed] = std::from_chars(at, end, n[count]);
            if (failed != std::errc() || !std::isfinite(n[count])) break;
            at = next;
            if (count < 7 && (at == end || *at++ != ',')) break;
        }
        const Camera camera{{n[1], n[2], n[3]}, {n[4], n[5], n[6]}, n[7]};
        const std::string hint = "a row is time,ex,ey,ez,tx,ty,tz,fov", where = fmt::format("{}:{}", file, number);
        if (count != 8 || at != end)
            return Error{ErrorCode::bad_input, fmt::format("'{:.60}' is not a camera", line), where, hint};
        if (const std::optional<std::string> fault = find_fault(camera); fault)
            return Error{ErrorCode::bad_input, *fault, where, hint};
        stations.push_back({n[0], camera});
    }
    if (stations.empty())
        return Error{ErrorCode::bad_input, "holds no camera", file, "a row is time,ex,ey,ez,tx,ty,tz,fov"};
    return stations;
}

std::vector<Camera> at_equal_times(const std::vector<CameraStation>& stations, double rate, std::size_t most) {
    const double begin = stations.front().time, length = stations.back().time - begin;
    const double count = std::floor(length * rate + 1e-9) + 1;
    std::vector<Camera> out;
    if (!(count >= 1 && count <= static_cast<double>(most))) return out;
    std::size_t next = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const double time = begin + static_cast<double>(i) / rate;
        while (next + 1 < stations.size() && stations[next].time < time) ++next;
        const CameraStation &b = stations[next], &a = stations[next > 0 ? next - 1 : 0];
        const double t = b.time > a.time ? std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0) : 1;
        Camera camera = b.camera;
        camera.eye = a.camera.eye + t * (b.camera.eye - a.camera.eye);
        camera.target = a.camera.target + t * (b.camera.target - a.camera.target);
        camera.fov = a.camera.fov + t * (b.camera.fov - a.camera.fov);
        if (camera.eye == camera.target) camera = b.camera;
        out.push_back(camera);
    }
    return out;
}

}  // namespace exitance

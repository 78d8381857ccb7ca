#include "exitance/cli/camera_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/reconstruct/pictures/automatic_camera.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// A camera that came with the scene.
Result<Camera> find_camera(const RenderArguments& arguments, const Scene& scene) {
    const std::vector<SceneCamera>& all = scene.cameras();
    const std::string& name = arguments.camera_name;
    auto found = std::find_if(all.begin(), all.end(), [&](const SceneCamera& c) { return c.name == name; });
    std::size_t number = 0;
    const auto [end, failed] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (found == all.end() && failed == std::errc() && end == name.data() + name.size() && number >= 1 &&
        number <= all.size())
        found = all.begin() + static_cast<std::ptrdiff_t>(number - 1);
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const SceneCamera& c : all) names.push_back(fmt::format("'{}'", c.name));
        return Error{ErrorCode::usage, fmt::format("the scene has no camera '{}'", name), "--camera",
                     all.empty() ? "no camera came with the scene: give 'ex,ey,ez tx,ty,tz fov'"
                                 : fmt::format("it has {}", fmt::join(names, ", "))};
    }
    Camera camera{found->eye, found->target, found->fov, found->up, arguments.projection};
    if (found->width > 0) camera.fov = found->width, camera.projection = Projection::orthographic;
    return camera;
}

}  // namespace

Result<Camera> choose_camera(const RenderArguments& arguments, const RadiosityFunction& light) {
    const Solution& solution = light.solution();
    if (!arguments.camera_name.empty()) return find_camera(arguments, solution.scene);
    if (!arguments.camera)
        return automatic_camera(solution, light.stage().tracer, arguments.projection, arguments.size);
    Camera camera = *arguments.camera;
    camera.projection = arguments.projection;
    if (camera.projection == Projection::fisheye) camera.fov = 180;
    if (camera.projection == Projection::orthographic) camera.fov = solution.scene.size();
    if (arguments.fov) camera.fov = *arguments.fov;
    return camera;
}

Result<std::vector<Camera>> load_camera_path(const std::string& file) {
    const Result<std::string> text = read_whole_file(file);
    if (!text) return text.error();
    std::istringstream in(*text);
    std::vector<Camera> cameras;
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
        if (count != 8 || at != end || !(n[7] >= 1 && n[7] <= 170) || camera.eye == camera.target)
            return Error{ErrorCode::bad_input, fmt::format("'{:.60}' is no camera", line),
                         fmt::format("{}:{}", file, number), "a row is time,ex,ey,ez,tx,ty,tz,fov"};
        cameras.push_back(camera);
    }
    if (cameras.empty())
        return Error{ErrorCode::bad_input, "holds no camera", file, "a row is time,ex,ey,ez,tx,ty,tz,fov"};
    return cameras;
}

std::string describe(const Camera& c) {
    return fmt::format("{:.7g},{:.7g},{:.7g} {:.7g},{:.7g},{:.7g} {:.7g}", c.eye.x, c.eye.y, c.eye.z, c.target.x,
                       c.target.y, c.target.z, c.fov);
}

}  // namespace exitance

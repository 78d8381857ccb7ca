#include "exitance/cli/camera_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "exitance/measure/pictures/automatic_camera.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// The camera of the scene with the requested name or number (from 1). Error (usage): there is none.
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
    if (const std::optional<std::string> fault = find_fault(camera); fault)
        return Error{ErrorCode::usage, *fault, "--camera", ""};
    return camera;
}

std::string describe(const Camera& c) {
    return fmt::format("{:.7g},{:.7g},{:.7g} {:.7g},{:.7g},{:.7g} {:.7g}", c.eye.x, c.eye.y, c.eye.z, c.target.x,
                       c.target.y, c.target.z, c.fov);
}

}  // namespace exitance

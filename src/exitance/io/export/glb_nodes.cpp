#include "exitance/io/export/glb_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/words.hpp"
#include "exitance/io/pictures/tone_map.hpp"

namespace exitance {
namespace {

/// Assumed ratio of width to height of a camera's picture, since scenes only store the horizontal angle.
constexpr double aspect = 1.6;

Vec3 turned_up(const Vec3& v) {
    return {v.x, v.z, -v.y};
}

/// A node's matrix by columns. It turns -z to `ahead`; `ahead`, `up` and `at` are in coordinates with Z up.
std::string matrix(const Vec3& ahead, const Vec3& up, const Point& at) {
    const Vec3 none;  // zero vector: adding it turns -0 into 0
    const Vec3 z = none - normalized(turned_up(ahead));
    const Vec3 x = none + (norm(cross(turned_up(up), z)) > 1e-6 ? normalized(cross(turned_up(up), z)) : Frame(z).u);
    const Vec3 y = none + cross(z, x), o = none + turned_up(at);
    return fmt::format("[{},{},{},0,{},{},{},0,{},{},{},0,{},{},{},1]", x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z,
                       o.x, o.y, o.z);
}

/// Formats a light, with an intensity in candela (lux for parallel light). Since glTF limits colours to 1, the
/// intensity is the largest component.
std::string light_json(const PunctualLight& light) {
    const auto [r, g, b] = red_green_blue(light.intensity);
    const double strength = std::max({r, g, b, 1e-30});
    const char* kind = light.kind == PunctualLight::Kind::spot    ? "spot"
                       : light.kind == PunctualLight::Kind::point ? "point"
                                                                  : "directional";
    std::string cones;
    if (light.kind == PunctualLight::Kind::spot)
        cones = fmt::format(",\"spot\":{{\"innerConeAngle\":{},\"outerConeAngle\":{}}}", light.inner_cone,
                            light.outer_cone);
    return fmt::format("{{\"name\":{},\"type\":\"{}\",\"color\":[{},{},{}],\"intensity\":{}{}}}", json_text(light.name),
                       kind, r / strength, g / strength, b / strength, strength, cones);
}

std::string camera_json(const SceneCamera& camera, double size) {
    const std::string name = json_text(camera.name);
    if (camera.width > 0)
        return fmt::format(
            "{{\"name\":{},\"type\":\"orthographic\",\"orthographic\":{{\"xmag\":{},\"ymag\":{},\"znear\":0,\"zfar\":{}"
            "}}}}",
            name, 0.5 * camera.width, 0.5 * camera.width / aspect, 10 * size);
    const double across = std::tan(camera.fov * pi / 360);
    return fmt::format(
        "{{\"name\":{},\"type\":\"perspective\",\"perspective\":{{\"aspectRatio\":{},\"yfov\":{},\"znear\":{}}}}}",
        name, aspect, 2 * std::atan(across / aspect), 1e-4 * size);
}

}  // namespace

GlbNodes make_light_and_camera_nodes(const Scene& scene) {
    GlbNodes out;
    const auto add = [&](std::string& to, const std::string& item) { to += (to.empty() ? "" : ",") + item; };
    const auto add_node = [&](const std::string& name, const std::string& what, const std::string& place) {
        const bool stays = place == "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";  // the default need not be written
        const std::string matrix_entry = stays ? "" : ",\"matrix\":" + place;
        add(out.nodes, fmt::format("{{\"name\":{},{}{}}}", json_text(name), what, matrix_entry));
        ++out.count;
    };
    for (std::size_t i = 0; i < scene.lights().size(); ++i) {
        const PunctualLight& light = scene.lights()[i];
        add(out.lights, light_json(light));
        const Point at = light.is_directional() ? scene.box().centre() : light.position;
        add_node(light.name, fmt::format("\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":{}}}}}", i),
                 matrix(light.direction, {0, 0, 1}, at));
    }
    for (std::size_t i = 0; i < scene.cameras().size(); ++i) {
        const SceneCamera& camera = scene.cameras()[i];
        add(out.cameras, camera_json(camera, scene.size()));
        add_node(camera.name, fmt::format("\"camera\":{}", i),
                 matrix(camera.target - camera.eye, camera.up, camera.eye));
    }
    return out;
}

}  // namespace exitance

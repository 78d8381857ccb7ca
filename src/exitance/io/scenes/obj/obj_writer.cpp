#include "exitance/io/scenes/obj/obj_writer.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

void append(std::string& out, const char* key, const Spectrum& values) {
    out += key;
    for (double v : values.value) fmt::format_to(std::back_inserter(out), " {}", v);
    out += '\n';
}

std::string mtl_text(const SceneDescription& scene) {
    std::string out;
    for (const Material& m : scene.materials) {
        out += "newmtl " + m.name + '\n';
        append(out, "Kd", m.reflectance);
        if (m.emits()) append(out, "Ke", m.exitance / pi);
    }
    return out;
}

std::string obj_text(const SceneDescription& scene, const std::string& library) {
    std::string out;
    const auto print = std::back_inserter(out);
    fmt::format_to(print, "# {} polygons\nmtllib {}\n", scene.faces.size(), library);
    for (const Point& p : scene.points) fmt::format_to(print, "v {} {} {}\n", p.x, p.y, p.z);
    constexpr std::uint32_t none = 0xffffffffu;
    std::uint32_t group = none, material = none;
    for (const auto& face : scene.faces) {
        if (face.group != group) fmt::format_to(print, "g {}\n", scene.groups[group = face.group]);
        if (face.material != material)
            fmt::format_to(print, "usemtl {}\n", scene.materials[material = face.material].name);
        out += 'f';
        for (std::uint32_t c : face.corners) fmt::format_to(print, " {}", c + 1);
        out += '\n';
    }
    return out;
}

}  // namespace

Result<void> write_obj(const SceneDescription& scene, const std::string& path) {
    const std::filesystem::path library = std::filesystem::path(path).replace_extension(".mtl");
    // The library is written first, so that a program that reads the new scene finds its materials.
    if (auto written = write_file(library.string(), mtl_text(scene)); !written) return written;
    return write_file(path, obj_text(scene, library.filename().string()));
}

}  // namespace exitance

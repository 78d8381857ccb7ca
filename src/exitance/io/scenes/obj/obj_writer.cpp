#include "exitance/io/scenes/obj/obj_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <iterator>
#include <map>

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

std::string obj_text(const SceneDescription& scene, const std::string& library, std::span<const Vec2> places) {
    std::string out;
    const auto print = std::back_inserter(out);
    fmt::format_to(print, "# {} polygons\nmtllib {}\n", scene.faces.size(), library);
    for (const Point& p : scene.points) fmt::format_to(print, "v {} {} {}\n", p.x, p.y, p.z);
    for (const Vec2& p : places) fmt::format_to(print, "vt {} {}\n", p.x, 1 - p.y);
    std::size_t place = 0;
    constexpr std::uint32_t none = 0xffffffffu;
    std::uint32_t group = none, material = none;
    for (const auto& face : scene.faces) {
        if (face.group != group) fmt::format_to(print, "g {}\n", scene.groups[group = face.group]);
        if (face.material != material)
            fmt::format_to(print, "usemtl {}\n", scene.materials[material = face.material].name);
        out += 'f';
        for (std::uint32_t c : face.corners) {
            fmt::format_to(print, " {}", c + 1);
            if (!places.empty()) fmt::format_to(print, "/{}", ++place);
        }
        out += '\n';
    }
    return out;
}

}  // namespace

Result<void> write_obj(const SceneDescription& scene, const std::string& path, std::span<const Vec2> places) {
    const std::filesystem::path library = std::filesystem::path(path).replace_extension(".mtl");
    // The library is written first, so that a program that reads the new scene finds its materials.
    if (auto written = write_file(library.string(), mtl_text(scene)); !written) return written;
    return write_file(path, obj_text(scene, library.filename().string(), places));
}

SceneDescription describe_polygons(const Scene& scene) {
    SceneDescription out;
    out.file = scene.file(), out.photometric = scene.is_photometric();
    out.materials.assign(scene.materials().begin(), scene.materials().end());
    out.groups.assign(scene.groups().begin(), scene.groups().end());
    std::map<std::array<double, 3>, std::uint32_t> number_of;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        SceneDescription::Face face{{}, surface.material.value, surface.group.value, surface.line};
        for (const Point& p : scene.outline(s)) {
            const auto [known, is_new] =
                number_of.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(out.points.size()));
            if (is_new) out.points.push_back(p);
            face.corners.push_back(known->second);
        }
        out.faces.push_back(std::move(face));
    }
    return out;
}

}  // namespace exitance

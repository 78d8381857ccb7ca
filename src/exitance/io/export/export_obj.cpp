#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "exitance/io/export/element_mesh.hpp"
#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/pictures/tone_map.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// Converts a name to one word, as OBJ and MTL require. An empty name becomes `otherwise` with the number.
std::string word(const std::string& name, std::size_t number, const char* otherwise) {
    std::string out = name.empty() ? otherwise + std::to_string(number) : name;
    for (char& c : out)
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '#') c = '_';
    return out;
}

/// The names of materials as unique words.
std::vector<std::string> material_words(const Scene& scene) {
    std::vector<std::string> words;
    for (MaterialId m : scene.materials().ids()) {
        std::string name = word(scene.materials()[m].name, m.value, "material");
        while (std::find(words.begin(), words.end(), name) != words.end()) name += '_';
        words.push_back(std::move(name));
    }
    return words;
}

Result<void> write_mtl(const Scene& scene, const std::vector<std::string>& names, const std::string& path) {
    std::string text = "# materials of an exitance export: Kd reflectance, Ke radiance in W/(m^2 sr)\n";
    const auto add = [&](const char* key, const Spectrum& value) {
        if constexpr (bands == 3)
            fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", key, value[0], value[1], value[2]);
        else
            fmt::format_to(std::back_inserter(text), "{0} {1} {1} {1}\n", key, mean(value));
    };
    for (MaterialId m : scene.materials().ids()) {
        text += "newmtl " + names[m.value] + "\n";
        add("Kd", scene.materials()[m].reflectance);
        if (scene.materials()[m].emits()) add("Ke", radiance_of_exitance(scene.materials()[m].exitance));
    }
    return write_file(path, text);
}

}  // namespace

Result<void> write_obj(const Solution& solution, const std::string& path) {
    const Scene& scene = solution.scene;
    const ElementMesh mesh = make_element_mesh(solution);
    const ToneMap tone = make_tone_map(solution);
    const std::vector<std::string> materials = material_words(scene);
    const std::string mtl = path.substr(0, path.size() - 4) + ".mtl";
    if (const Result<void> written = write_mtl(scene, materials, mtl); !written) return written;

    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    const auto pass_on = [&](std::size_t from) {
        if (text.size() < from) return;
        file->write(std::string_view(text.data(), text.size()));
        text.clear();
    };
    const std::size_t full = 1 << 16;
    fmt::format_to(out,
                   "# leaves of an exitance solution; metres, Z up; colours: sRGB of the radiosity in {}, "
                   "tone-mapped by {:.6g}\nmtllib {}\n",
                   own_unit(solution.scene.is_photometric()).radiosity(), tone.scale, mtl.substr(mtl.rfind('/') + 1));
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        Spectrum light;
        for (std::size_t b = 0; b < bands; ++b) light[b] = static_cast<double>(mesh.radiosity[i][b]);
        const DisplayColour c = tone(light);
        const Point& p = mesh.points[i];
        fmt::format_to(out, "v {} {} {} {:.4f} {:.4f} {:.4f}\n", p.x, p.y, p.z, srgb_encoded(c[0]), srgb_encoded(c[1]),
                       srgb_encoded(c[2]));
        pass_on(full);
    }
    std::vector<std::size_t> order(mesh.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(mesh.group[a], mesh.material[a]) < std::pair(mesh.group[b], mesh.material[b]);
    });
    std::int32_t group = -1, material = -1;
    for (const std::size_t i : order) {
        if (mesh.group[i] != group) {
            group = mesh.group[i], material = -1;
            const auto g = static_cast<std::size_t>(group);
            fmt::format_to(out, "g {}\n", word(scene.groups()[GroupId(g)], g, "group"));
        }
        if (mesh.material[i] != material) {
            material = mesh.material[i];
            fmt::format_to(out, "usemtl {}\n", materials[static_cast<std::size_t>(material)]);
        }
        fmt::format_to(out, "f");
        for (std::uint32_t k = mesh.first_point[i]; k < mesh.first_point[i + 1]; ++k) fmt::format_to(out, " {}", k + 1);
        fmt::format_to(out, "\n");
        pass_on(full);
    }
    pass_on(0);
    return file->commit();
}

}  // namespace exitance

#include <fmt/format.h>

#include <cstdlib>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/lab/peers/peer_scripts.hpp"
#include "exitance/lab/peers/peers.hpp"

namespace exitance {
namespace {

Result<std::vector<std::string>> prepare_blender(const PeerTask& task) {
    const auto options = named_options(task, {{"samples", "64"}, {"bounces", "64"}});
    if (!options) return options.error();
    std::string triangles, points;
    for (const PeerScene::Face& face : task.scene.faces)
        for (const auto& corners : face.triangles) {
            for (const std::uint32_t corner : corners) {
                const Point& p = face.outline[corner];
                triangles += fmt::format("{:.9g},{:.9g},{:.9g},", p.x, p.y, p.z);
            }
            const Spectrum &r = face.reflectance, &m = face.exitance;
            triangles += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", r[0], r[1], r[2], m[0], m[1], m[2]);
        }
    for (const auto& [point, rho, m] : task.scene.places) {
        const auto& [x, n] = point;
        points += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", x.x, x.y, x.z, n.x, n.y, n.z);
    }
    const std::pair<const char*, std::string_view> files[] = {
        {"triangles.csv", triangles}, {"points.csv", points}, {"bake.py", blender_script}};
    for (const auto& [name, text] : files)
        if (const Result<void> written = write_file(task.folder + "/" + name, std::string(text)); !written)
            return written.error();
    return std::vector<std::string>{"blender",
                                    "--background",
                                    "--factory-startup",
                                    "--python-exit-code",
                                    "3",
                                    "--threads",
                                    std::to_string(task.threads),
                                    "--python",
                                    task.folder + "/bake.py",
                                    "--",
                                    task.folder,
                                    options->at("samples"),
                                    options->at("bounces"),
                                    fmt::format("{:.9g}", task.scene.size)};
}

Result<PeerLight> read_blender(const PeerTask& task, const ProgramRun&) {
    const Result<std::string> text = read_whole_file(task.folder + "/irradiance.csv");
    if (!text) return text.error();
    const Result<Table> table = parse_csv(*text, "irradiance.csv");
    if (!table) return table.error();
    PeerLight light;
    for (std::size_t i = 0; i < table->rows.size(); ++i) {
        Spectrum& irradiance = light.irradiance.emplace_back();
        for (std::size_t band = 0; band < bands && band < 3; ++band)
            irradiance[band] = table->number(i, std::array{"r", "g", "b"}[band]);
    }
    if (const Result<std::string> seconds = read_whole_file(task.folder + "/seconds.txt"))
        light.seconds = std::strtod(seconds->c_str(), nullptr);
    return light;
}

}  // namespace

const Peer blender_peer{"blender", "blender", prepare_blender, "", read_blender};

}  // namespace exitance

#include <fmt/format.h>

#include <numbers>
#include <sstream>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/lab/peers/peers.hpp"

namespace exitance {
namespace {

/// An emitter is a source ("illum"), with another material for rays that hit it.
std::string polygon_text(const PeerScene::Face& face, std::size_t number) {
    const Spectrum &rho = face.reflectance, &m = face.exitance;
    std::string text =
        fmt::format("void plastic r{}\n0\n0\n5 {:.9g} {:.9g} {:.9g} 0 0\n", number, rho[0], rho[1], rho[2]);
    const bool emits = max(m) > 0;
    if (emits) {
        const Spectrum radiance = m * (1 / std::numbers::pi);
        text += fmt::format("void illum m{}\n1 r{}\n0\n3 {:.9g} {:.9g} {:.9g}\n", number, number, radiance[0],
                            radiance[1], radiance[2]);
    }
    text += fmt::format("{}{} polygon p{}\n0\n0\n{}", emits ? "m" : "r", number, number, 3 * face.outline.size());
    for (const Point& p : face.outline) text += fmt::format(" {:.9g} {:.9g} {:.9g}", p.x, p.y, p.z);
    return text + "\n";
}

Result<std::vector<std::string>> prepare_radiance(const PeerTask& task) {
    std::string scene, points;
    for (std::size_t i = 0; i < task.scene.faces.size(); ++i) scene += polygon_text(task.scene.faces[i], i);
    for (const auto& [point, rho, m] : task.scene.places) {
        const Point x = point.x + 1e-4 * task.scene.size * point.n;
        points +=
            fmt::format("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z, point.n.x, point.n.y, point.n.z);
    }
    for (const auto& [name, text] : {std::pair("scene.rad", &scene), std::pair("points.txt", &points)})
        if (const Result<void> written = write_file(fmt::format("{}/{}", task.folder, name), *text); !written)
            return written.error();
    std::vector<std::string> words{"rtrace", "-h", "-I+", "-n", std::to_string(task.threads)};
    words.insert(words.end(), task.options.begin(), task.options.end());
    words.push_back("!oconv scene.rad");
    return words;
}

Result<PeerLight> read_radiance(const PeerTask&, const ProgramRun& run) {
    PeerLight light;
    std::istringstream text(run.out);
    for (Spectrum e; text >> e[0] >> e[1] >> e[2];) light.irradiance.push_back(e);
    return light;
}

}  // namespace

const Peer radiance_peer{"radiance", "rtrace", prepare_radiance, "points.txt", read_radiance};

}  // namespace exitance

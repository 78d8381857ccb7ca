#include <fmt/format.h>

#include <numbers>
#include <sstream>

#include "exitance/experiments/peers/peers.hpp"
#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

std::string polygon_text(const PeerScene::Triangle& t, std::size_t number) {
    const bool emits = max(t.exitance) > 0;
    const Spectrum& c = emits ? t.exitance : t.reflectance;
    const double share = emits ? 1 / std::numbers::pi : 1;
    std::string text =
        fmt::format("void {} m{}\n0\n0\n{} {:.9g} {:.9g} {:.9g}{}\n", emits ? "light" : "plastic", number,
                    emits ? 3 : 5, share * c[0], share * c[1], share * c[2], emits ? "" : " 0 0");
    text += fmt::format("m{} polygon p{}\n0\n0\n9", number, number);
    for (const Point& p : t.corners) text += fmt::format(" {:.9g} {:.9g} {:.9g}", p.x, p.y, p.z);
    return text + "\n";
}

/// What emits reflects nothing there.
Result<std::vector<std::string>> prepare(const PeerTask& task) {
    std::string scene, points;
    for (std::size_t i = 0; i < task.scene.triangles.size(); ++i) scene += polygon_text(task.scene.triangles[i], i);
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

Result<PeerLight> read(const PeerTask&, const ProgramRun& run) {
    PeerLight light;
    std::istringstream text(run.out);
    for (Spectrum e; text >> e[0] >> e[1] >> e[2];) light.irradiance.push_back(e);
    return light;
}

}  // namespace

const Peer radiance_peer{"radiance", "rtrace", prepare, "points.txt", read};

}  // namespace exitance

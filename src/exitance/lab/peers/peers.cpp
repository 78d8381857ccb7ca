#include "exitance/lab/peers/peers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "exitance/base/triangulation.hpp"
#include "exitance/scene/locator.hpp"

namespace exitance {

namespace {

constexpr std::array<const Peer*, 3> peers{&blender_peer, &povray_peer, &radiance_peer};

}  // namespace

std::vector<std::string_view> peer_names() {
    std::vector<std::string_view> names;
    for (const Peer* peer : peers) names.push_back(peer->name);
    return names;
}

const Peer* find_peer(std::string_view name) {
    const auto at = std::find_if(peers.begin(), peers.end(), [&](const Peer* p) { return p->name == name; });
    return at == peers.end() ? nullptr : *at;
}

PeerScene peer_scene(const Scene& scene, const ReferencePoints& reference) {
    PeerScene out;
    Box box;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const std::span<const Point> outline = scene.outline(s);
        const Material& material = scene.material(s);
        out.faces.push_back(
            {outline, triangulate(outline, scene.surfaces()[s].normal), material.reflectance, material.exitance});
        for (const Point& p : outline) box.add(p);
        out.max_light = std::max(out.max_light, max(material.exitance));
    }
    out.size = box.diagonal();
    const Locator locator(scene);
    for (const ProbePoint& point : reference.points) {
        const SurfaceId s = locator.find(point.x, point.n);
        out.places.push_back({point, {}, {}});
        if (s.is_none()) continue;
        out.places.back().reflectance = scene.material(s).reflectance;
        out.places.back().exitance = scene.material(s).exitance;
    }
    for (const Spectrum& light : reference.irradiance) out.max_light = std::max(out.max_light, max(light));
    return out;
}

Result<std::map<std::string, std::string>> named_options(const PeerTask& task,
                                                         std::map<std::string, std::string> defaults) {
    for (const std::string& word : task.options) {
        const std::size_t equals = word.find('=');
        const auto at = defaults.find(word.substr(0, equals));
        if (equals == std::string::npos || at == defaults.end()) {
            std::vector<std::string> names;
            for (const auto& [name, value] : defaults) names.push_back(name);
            return Error{ErrorCode::usage, fmt::format("'{}' is no option of this peer", word), "options",
                         fmt::format("name=value, with {}", fmt::join(names, ", "))};
        }
        at->second = word.substr(equals + 1);
    }
    return defaults;
}

}  // namespace exitance

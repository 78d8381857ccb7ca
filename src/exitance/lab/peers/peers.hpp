#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/reference/reference_points.hpp"

namespace exitance {

/// A scene as other programs take it: polygons that reflect and emit from their fronts, black behind; metres, W/m^2.
struct PeerScene {
    struct Face {
        std::span<const Point> outline;
        std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Of its corners.
        Spectrum reflectance, exitance;
    };
    /// A point of a surface, where light is wanted.
    struct Place {
        ProbePoint point;
        Spectrum reflectance, exitance;
    };
    std::vector<Face> faces;
    std::vector<Place> places;
    double size = 0;        ///< The diagonal of its box.
    double most_light = 0;  ///< No smaller than the largest radiosity at the places, W/m^2.
};

/// What a peer is to run, and with what.
struct PeerTask {
    const PeerScene& scene;
    std::vector<std::string> options;  ///< Of a study's row, word by word.
    int threads = 1;
    std::string folder;  ///< For its files.
};

struct PeerLight {
    std::vector<Spectrum> irradiance;  ///< At the points, W/m^2; a band that reflects nothing may be left 0.
    std::optional<double> seconds;     ///< That the peer took for light alone, as it tells them itself.
};

/// Somebody else's program, which makes the light of a scene.
struct Peer {
    std::string_view name;     ///< As rows of studies have it: `peer = "blender"`.
    std::string_view program;  ///< It runs where this is found in PATH.
    /// Writes what the program reads; returns the words that start it. Error: usage, for options that it has not.
    Result<std::vector<std::string>> (*prepare)(const PeerTask& task);
    std::string_view input;  ///< What it reads from its standard input: a file in its folder, or nothing.
    /// Reads what it wrote. Error: bad_input, where that is not the light of all points.
    Result<PeerLight> (*read)(const PeerTask& task, const ProgramRun& run);
};

/// Cycles bakes diffuse light into a texel a point: options `samples=N bounces=N`.
extern const Peer blender_peer;
/// POV-Ray's radiosity, by its mesh camera, a pixel a point: options `count=N error_bound=X recursion_limit=N
/// nearest_count=N`. It tells radiosity: bands that reflect nothing stay 0. Backs reflect and emit as fronts do, which
/// closed scenes do not show.
extern const Peer povray_peer;
/// Radiance's `rtrace -I`: its own options.
extern const Peer radiance_peer;

std::vector<std::string_view> peer_names();
/// None of that name: null.
const Peer* find_peer(std::string_view name);

/// The scene, which outlives what is returned, and points with the light that is expected there. Points in free space
/// reflect nothing.
PeerScene peer_scene(const Scene& scene, const ReferencePoints& reference);

/// Words `name=value` over defaults. Error: usage, for a name that has no default.
Result<std::map<std::string, std::string>> named_options(const PeerTask& task,
                                                         std::map<std::string, std::string> defaults);

}  // namespace exitance

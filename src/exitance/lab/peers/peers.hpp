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

/// A scene in the form that other programs need: polygons that reflect and emit from their fronts and are black behind;
/// metres, W/m^2.
struct PeerScene {
    struct Face {
        std::span<const Point> outline;
        std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices of each triangle's corners.
        Spectrum reflectance, exitance;
    };
    /// A surface point at which light is wanted.
    struct Place {
        ProbePoint point;
        Spectrum reflectance, exitance;
    };
    std::vector<Face> faces;
    std::vector<Place> places;
    double size = 0;       ///< Diagonal of its bounding box, metres.
    double max_light = 0;  ///< At least the largest radiosity at the places, W/m^2.
};

/// Input of a peer's run.
struct PeerTask {
    const PeerScene& scene;
    std::vector<std::string> options;  ///< Options of a study's row, word by word.
    int threads = 1;
    std::string folder;  ///< Folder for the peer's files.
};

struct PeerLight {
    std::vector<Spectrum> irradiance;  ///< At the points, W/m^2; may be 0 in a band that reflects nothing.
    std::optional<double> seconds;     ///< Time for light only, if the peer reports it.
};

/// Another program that computes the light of a scene.
struct Peer {
    std::string_view name;     ///< Name in rows of studies: `peer = "blender"`.
    std::string_view program;  ///< Executable to be found in PATH.
    /// Writes the program's input files and returns its command line. Error: usage, for unsupported options.
    Result<std::vector<std::string>> (*prepare)(const PeerTask& task);
    std::string_view input;  ///< File in its folder for standard input, or empty.
    /// Reads the program's results. Error: bad_input, if they do not contain the light of all points.
    Result<PeerLight> (*read)(const PeerTask& task, const ProgramRun& run);
};

/// Cycles, baking diffuse light into one texel per point. Options: `samples=N bounces=N`.
extern const Peer blender_peer;
/// POV-Ray's radiosity with its mesh camera, one pixel per point. Options: `count=N error_bound=X recursion_limit=N
/// nearest_count=N`. It yields radiosity, so bands that reflect nothing stay 0. Backs reflect and emit like fronts,
/// which is invisible in closed scenes.
extern const Peer povray_peer;
/// Radiance's `rtrace -I` with its own options.
extern const Peer radiance_peer;

std::vector<std::string_view> peer_names();
/// Returns null for an unknown name.
const Peer* find_peer(std::string_view name);

/// Converts a scene, which must outlive the result, with the points of the reference and its light. Points in free
/// space reflect nothing.
PeerScene peer_scene(const Scene& scene, const ReferencePoints& reference);

/// Parses words `name=value` over defaults. Error: usage, for a name without a default.
Result<std::map<std::string, std::string>> named_options(const PeerTask& task,
                                                         std::map<std::string, std::string> defaults);

}  // namespace exitance

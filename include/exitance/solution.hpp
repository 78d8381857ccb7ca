#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exitance/progress.hpp"
#include "exitance/scene.hpp"

namespace exitance::api {

/// A point and the unit normal of the plane on which light is measured there. Points on a surface, with its normal,
/// give the light of the surface; other points are sensors in the air.
struct Probe {
    Vec3 point;   ///< Metres.
    Vec3 normal;  ///< Direction of any length above 0.
};

/// Part of the light that is evaluated: all of it, the light that arrives from emitters without reflection, or the
/// rest.
enum class Component { total, direct, indirect };

/// Light at a probe.
struct Light {
    Spectrum irradiance;      ///< W/m^2
    Spectrum radiosity;       ///< W/m^2: emitted and reflected; undefined if `on_surface` is false.
    bool on_surface = false;  ///< True if the probe is on a face that faces along its normal.
};

/// Emitted flux and its destinations, W (lm if the scene is photometric): means over the bands.
struct Energy {
    double emitted = 0;
    double absorbed = 0;
    double escaped = 0;  ///< Left the scene without meeting a face.
    double defect = 0;   ///< |emitted - absorbed - escaped| / emitted
};

/// The light on triangles, for drawing and for other programs. Vertices of one flat part of a surface are shared;
/// those of different surfaces are not, since light jumps there.
struct Mesh {
    std::vector<std::array<double, 3>> vertices;          ///< Metres.
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Counter-clockwise seen from the front.
    std::vector<std::array<float, bands>> irradiance;     ///< Per vertex, W/m^2.
    std::vector<std::array<float, bands>> radiosity;      ///< Per vertex, W/m^2.
    std::vector<std::int32_t> face;                       ///< Per triangle: index of a face of the scene.
};

/// Changes of the lamps and materials of a solution.
struct Changes {
    std::vector<std::pair<std::string, double>> dim = {};            ///< Light groups by name, with factors from 0.
    std::vector<std::pair<std::string, Spectrum>> reflectance = {};  ///< Materials by name, in [0, 1).
};

struct SolutionData;

/// The light of a scene: B(x) = M + rho (E_dir(x) + E_ind(x)), evaluated anywhere. Direct light is exact, shadows
/// included; reflected light is read from elements. Copies share their data.
class Solution {
  public:
    /// Light at every probe, in their order. At points in the air, reflected light is gathered by rays. About 5 us per
    /// probe and visible emitter, on all cores.
    /// Errors: usage if a coordinate is not finite or a normal has no length; limit after a stop.
    Result<std::vector<Light>> light(std::span<const Probe> probes, Component component = Component::total,
                                     const Control& control = {}) const;

    /// Estimated relative RMS error of the light; none if it was not estimated.
    std::optional<double> error() const;
    /// Upper bound of that error with high confidence; none if it was not estimated.
    std::optional<double> error_bound() const;
    /// True if the requested error was reached, or none was requested.
    bool converged() const;
    /// The reason of an early end: "time limit", "memory limit", "iterations", "interrupt"; else empty.
    std::string stopped_by() const;
    /// Energy balance of the light.
    Energy energy() const;
    /// Sentences about possible faults of the light.
    std::vector<std::string> warnings() const;
    /// All statistics as JSON: the output of `exitance stats --json`.
    std::string statistics_json() const;
    Scene scene() const;

    /// The light on triangles, with an error of at most three times the requested one.
    Result<Mesh> mesh() const;
    /// Writes a mesh with the light; the ending selects the format: .vtkhdf, .vtu, .glb, .obj, .csv. The file appears
    /// whole or not at all. Errors: usage, cannot_write.
    Result<void> export_mesh(const std::string& path) const;
    /// Writes the solution (.h5), which load_solution() restores to the last bit. The file appears whole or not at all.
    /// Error: cannot_write.
    Result<void> save(const std::string& path) const;

    /// Names of the light groups, if the scene was made with `light_groups`; else empty.
    std::vector<std::string> light_groups() const;
    /// The light after dimming groups and repainting materials, without a new solve. Milliseconds to seconds.
    /// Errors: usage if the solution keeps no light groups, or for unknown names (the hint lists the known ones) and
    /// numbers out of range.
    Result<Solution> mix(const Changes& changes) const;

    /// For the library.
    explicit Solution(std::shared_ptr<const SolutionData> data) : data_(std::move(data)) {}
    const SolutionData& data() const { return *data_; }

  private:
    std::shared_ptr<const SolutionData> data_;
};

/// Reads a solution file, also of earlier versions since 0.3.
/// Errors: cannot_read; bad_input for a damaged file.
Result<Solution> load_solution(const std::string& path);

}  // namespace exitance::api

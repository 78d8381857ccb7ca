#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/light_maps/chart.hpp"
#include "exitance/measure/light_maps/curved_difference.hpp"

namespace exitance {

/// Form in which light maps describe the directions of light, for normal maps.
enum class Directions : std::uint8_t {
    none,
    sh,        ///< Spherical harmonics of degrees 0 and 1, for every band.
    dominant,  ///< One direction for all bands, and the share of the light that has it.
};

struct BakeOptions {
    double density = 0;                      ///< Texels per metre; 0: `automatic_density`.
    int padding = 4;                         ///< Texels around every chart, at least 1.
    int most = 8192;                         ///< Limit on texels along a side of a map, for display hardware.
    const CurvedFaces* curved = nullptr;     ///< Faces with the normals of the scene's file; null: all are flat.
    Component component = Component::total;  ///< Part of the light.
    Directions directions = Directions::none;
};

/// One image of irradiance, rows from top to bottom.
struct LightMap {
    /// Origin of a texel's value.
    enum class Source : std::uint8_t {
        nothing,       ///< No source: the texel belongs to no chart, and its value is 0.
        computed,      ///< Mean over the part of the texel that is on the region and not covered.
        extrapolated,  ///< Neighbouring texels; the texel is outside the region, or covered by an object.
        buried,        ///< No source: an object covers the texel, far from uncovered ones; its value is 0.
    };

    MapSize size;
    std::vector<std::array<float, bands>> irradiance;  ///< W/m^2
    std::vector<Source> source;
    std::vector<float> share;  ///< Share of every texel that its region covers; 0 outside.
    /// Irradiance as a linear function of the normal (DirectedIrradiance), W/m^2: the constant, and the slopes along x,
    /// y, z. Empty vectors in maps without directions.
    std::array<std::vector<std::array<float, bands>>, 4> directed = {};
    bool has_emission = true;  ///< True if radiosity contains the surfaces' emission, which is direct light.

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
    }
    bool has_directions() const { return !directed[0].empty(); }
    Spectrum at(std::size_t i) const {
        Spectrum out;
        for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(irradiance[i][b]);
        return out;
    }
};

/// A solution's irradiance as images that cover its surfaces.
struct LightMaps {
    double density = 0;  ///< Texels per metre.
    int padding = 0;
    std::vector<Chart> charts;  ///< One chart per region, in the order of their ids.
    std::vector<LightMap> maps;
    std::size_t texels = 0;    ///< Number of texels that are on surfaces, wholly or in part.
    CurvedDifferences curved;  ///< Light of curved regions compared with the solution; empty for a part of the light.
};

/// True if direct and indirect light of a solution are stored separately.
bool is_divisible(const Solution& solution);
/// Returns an error of code `usage` if the solution is not divisible and a part of its light is requested.
Result<void> check_component(const Solution& solution, Component component);

/// Automatic density: 64 texels per metre. In scenes smaller than 4 m it is higher, with 256 to 512 texels along the
/// diagonal; it is lower if the surfaces would have more than a million texels. A power of two.
double automatic_density(const Scene& scene);

/// Bakes the function that `probe` evaluates: exact direct light, and indirect light from the elements. A texel holds
/// the mean over the part that is on its region and not covered, from 16 stratified points where direct light may have
/// an edge and from one point where it certainly has none (TileLight): texels in fully lit areas and umbrae need no
/// visibility tests. If the solution has a discontinuity mesh, its polynomials are integrated exactly over the texel,
/// and the points only correct the difference: shadow edges are then as sharp as the mesh and free of noise. Points
/// that another surface covers, or that are inside a closed body, do not count, so that no darkness leaks from below
/// objects. Texels without other points, and those outside the region, are extrapolated from neighbouring texels:
/// linearly in the first ring outside, else by means (extrapolate_texels). Curved regions have the light of the surface
/// that their faces approximate (CurvedLight), from two to sixteen points.
/// Same bits on any number of threads. About 5 us per texel in a room with few lamps.
/// With directions, every texel also has the irradiance of tilted planes (TiltedLight); its own plane has that of the
/// map.
/// Maps of direct and indirect light add up to that of all light, but for rounding.
/// Returns an error of code `usage` if the maps would have more than 2^27 texels, or if the solution is not divisible
/// and a part of its light is requested; after a stop request the maps are incomplete.
Result<LightMaps> bake_light_maps(const RadiosityFunction& light, const BakeOptions& options, Progress& progress,
                                  const StopRequest& stop);

/// Fills the texels of a chart's rectangle that are not computed, ring by ring from the computed ones; of buried
/// texels, only `reach` rings are filled. The first ring outside the region is extrapolated linearly, with a change of
/// at most half of the light there, so that bilinear lookups at a border keep the slope. O(texels).
void extrapolate_texels(const Chart& chart, int reach, LightMap& map);

}  // namespace exitance

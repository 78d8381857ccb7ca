#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/light_maps/chart.hpp"

namespace exitance {

struct BakeOptions {
    double density = 0;  ///< Texels per metre; 0: `automatic_density`.
    int padding = 4;     ///< Texels around every chart, at least 1.
    int most = 8192;     ///< Texels along a side of a map: what display hardware reads.
};

/// One picture of irradiance, rows from top to bottom.
struct LightMap {
    /// What a texel's value comes from.
    enum class Source : std::uint8_t {
        nothing,       ///< It belongs to no chart: 0.
        computed,      ///< The mean over the part of the texel that lies on the region in the open.
        extrapolated,  ///< Its neighbours: it lies outside of the region, or beneath what stands on it.
        buried,        ///< It lies beneath what stands on the region, far from all texels in the open: 0.
    };

    MapSize size;
    std::vector<std::array<float, bands>> irradiance;  ///< W/m^2
    std::vector<Source> source;
    std::vector<float> share;  ///< Of every texel, the share that its region covers; 0 outside.

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
    }
    Spectrum at(std::size_t i) const {
        Spectrum out;
        for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(irradiance[i][b]);
        return out;
    }
};

/// A solution's irradiance as pictures that cover its surfaces.
struct LightMaps {
    double density = 0;  ///< Texels per metre.
    int padding = 0;
    std::vector<Chart> charts;  ///< One a region, in the order of their ids.
    std::vector<LightMap> maps;
    std::size_t texels = 0;  ///< That lie on surfaces, wholly or in part.
};

/// 64 texels per metre, in scenes of less than 4 m as many more that 256 to 512 lie along their diagonal; less where
/// the surfaces would have more than a million texels. A power of two.
double automatic_density(const Scene& scene);

/// Bakes the function that `probe` evaluates: exact direct light, indirect light from the elements. A texel holds the
/// mean over the part of it that lies on its region in the open, by 16 stratified points where direct light may have an
/// edge and by one where it certainly has none (TileLight): texels in lit and umbra parts cost no visibility. Where the
/// solution has a discontinuity mesh, its polynomials are integrated over the texel, exactly, and the points count what
/// they are off by: shadow edges are as sharp as the mesh and noiseless. Points
/// that another surface covers, or that lie inside a closed body, do not count, so that no darkness leaks from below
/// what stands on a surface; texels that have no other points, and those outside of the region, are extrapolated from
/// the texels next to them: outside linearly in the first ring, else by means (extrapolate_texels).
/// The same bits on any number of threads. About 5 us a texel in a room of few lamps.
/// returns an error of code `usage` where the maps would have more than 2^27 texels; after a stop maps not all done.
Result<LightMaps> bake_light_maps(const RadiosityFunction& light, const BakeOptions& options, Progress& progress,
                                  const StopRequest& stop);

/// Fills what is not computed of a chart's room: ring by ring from the texels that are, all of it but for buried
/// texels, of which `reach` rings are filled. The first ring outside of the region goes on linearly, by at most half of
/// the light there, so that bilinear lookup at a border keeps the slope. O(texels).
void extrapolate_texels(const Chart& chart, int reach, LightMap& map);

}  // namespace exitance

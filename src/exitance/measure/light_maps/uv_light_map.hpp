#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/light_maps/uv_layout.hpp"

namespace exitance {

struct UvBakeOptions {
    MapSize size = {};   ///< Texels of each map; 0: chosen by `density`.
    double density = 0;  ///< Texels per metre, at least, on average over a map; 0: `automatic_density`.
    int padding = 4;     ///< Texels beyond every chart that are extrapolated, at least 1.
    int most = 8192;     ///< Limit on texels along a side of a map, for display hardware.
    const CurvedFaces* curved = nullptr;     ///< Faces with the normals of the scene's file; null: all are flat.
    Component component = Component::total;  ///< Part of the light.
    Directions directions = Directions::none;
};

/// Irradiance and radiosity in the texture coordinates of a scene's file.
struct UvLightMap {
    using Values = std::vector<std::array<float, bands>>;

    LightMap light;
    Values radiosity;                  ///< B = M + rho E of each texel, W/m^2.
    std::vector<std::uint32_t> chart;  ///< The chart that covers most of a texel, or from which it is extrapolated.
    /// Quarters of a texel that `chart` touches: 1 upper left, 2 upper right, 4 lower left, 8 lower right.
    std::vector<std::uint8_t> quarters;
    double density = 0;             ///< Texels per metre, on average over the charts.
    std::size_t shared_texels = 0;  ///< Texels that several charts cover in part.
    std::size_t close_texels = 0;   ///< Texels outside of all charts that bilinear lookups on several charts read.
};

struct UvLightMaps {
    UvLayout layout;
    std::vector<UvLightMap> maps;
    int padding = 0;
    std::size_t texels = 0;  ///< Number of texels that charts cover, wholly or in part.
    CurvedDifferences curved;
};

/// Bakes the function that `probe` evaluates into the texture coordinates of a scene's file, see bake_light_maps. A
/// texel that is covered by several triangles, in one chart or in several, holds their mean, weighted by the areas of
/// their uncovered parts in the texel; these are clipped exactly. Texels outside of all charts are extrapolated from
/// one chart only (fill_gutters). Same bits on any number of threads. A texel costs as much as in bake_light_maps per
/// region and linear part of the texture coordinates that it touches.
/// Returns an error of code `usage` as check_component() does, if a map would have more than `most` texels along a
/// side, or all maps more than 2^27 texels, counted once per chart that covers them; after a stop request the maps are
/// incomplete.
Result<UvLightMaps> bake_uv_light_maps(const RadiosityFunction& light, const UvSet& set, const UvBakeOptions& options,
                                       Progress& progress, const StopRequest& stop);

/// Extrapolates the texels up to `padding` texels beyond the charts, and those that bilinear lookups read where an
/// object covers a chart. A texel continues one chart: the one on which bilinear lookups read it, else that of most of
/// its neighbours. Bilinear lookups on a chart then read no light of another chart that is two texels (or, if neither
/// is parallel to the map's sides, three) away. The first ring is extrapolated linearly, with a change of at most half
/// of the light there. Counts `close_texels`. O(texels).
void fill_gutters(UvLightMap& map, int padding);

}  // namespace exitance

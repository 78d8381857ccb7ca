#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/measure/light_maps/curved_borders.hpp"
#include "exitance/measure/light_maps/curved_light.hpp"
#include "exitance/measure/light_maps/light_map.hpp"
#include "exitance/measure/light_maps/mesh_texels.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"
#include "exitance/measure/light_maps/tilted_light.hpp"
#include "exitance/measure/pictures/tile_light.hpp"

namespace exitance {

inline constexpr double max_texels = 134217728;  ///< 2^27 texels, up to 6 GB while they are baked.

/// A part of a chart that is baked as a unit.
struct ChartTile {
    std::size_t chart = 0;
    Chart::Rectangle rectangle;  ///< Rectangle in texels of the chart.
};

std::vector<ChartTile> cut_into_tiles(std::span<const Chart> charts);

/// Light on the part of a texel that a chart covers.
struct BakedTexel {
    std::size_t index = 0;  ///< Index of the texel in the map.
    double share = 0;       ///< Share of the texel that the chart covers, in (0, 1].
    bool is_open = false;   ///< False: another surface or a body covers that part, so it has no light of its own.
    Spectrum irradiance;    ///< Mean of the component over the uncovered part, W/m^2; 0 if there is none.
    CurvedTexel curved = {};
    DirectedIrradiance directed = {};  ///< Zero unless directions are requested.
};

/// Bakes tiles one after the other, as described at bake_light_maps. One per thread; keeps its memory.
class TileBaker {
  public:
    /// outlines  triangles and parallelograms of each chart
    /// mesh      exact integrals over a discontinuity mesh; null: points only
    /// curved    light of curved regions; null: all regions are flat
    /// tilted    light on tilted planes; null: no directions
    /// All arguments must outlive the object. The light of an indivisible solution (is_divisible) has no other
    /// component than all of it.
    TileBaker(const RadiosityFunction& light, std::span<const std::vector<TexelOutline>> outlines,
              const MeshTexels* mesh, const CurvedLight* curved, const TiltedLight* tilted, Component component,
              const StopRequest& stop);

    /// Returns the texels that the chart covers in a tile. The range is valid until the next call.
    std::span<const BakedTexel> bake(const ChartTile& tile, const Chart& chart, const LightMap& map);

  private:
    Spectrum component_of(const Spot& spot) const;
    void find_open_points(const Chart& chart, const TexelCover& cover);
    void find_directions(const Chart& chart);
    void bake_curved(const Chart& chart, const TexelCover& cover, BakedTexel& texel);

    const Stage& stage_;
    const PlaceFinder& finder_;
    std::span<const std::vector<TexelOutline>> outlines_;
    const MeshTexels* mesh_;
    const CurvedLight* curved_;
    const TiltedLight* tilted_;
    Component component_;
    Spectrum exact_share_;  ///< The elements hold all light except this share of the exact direct light.
    const StopRequest& stop_;
    CurvedLight::Workspace curved_work_;
    TiltedLight::Workspace tilted_work_;
    TileLight light_;
    TexelCutter cutter_;
    std::vector<MeshTexels::Integral> integrals_;
    std::vector<TexelCover> covers_;
    std::vector<Vec2> places_;
    std::vector<MeasuredPlace> open_;              ///< Uncovered points of the last texel.
    std::vector<MeasuredPlace> places_of_texels_;  ///< Uncovered points of all texels, if directions are requested.
    std::vector<std::size_t> last_place_;          ///< For each texel, the end of its range of these.
    std::vector<Point> points_;
    std::vector<Spot> spots_;
    std::vector<BakedTexel> texels_;
};

/// Bakes tiles on all threads of all processes. Returns the texels of every tile; none of tiles that a stop left out.
/// map_of      returns the map of a chart by its number
/// make_baker  makes the baker of a thread
/// Collective.
std::vector<std::vector<BakedTexel>> bake_tiles(std::span<const ChartTile> tiles, std::span<const Chart> charts,
                                                const std::function<const LightMap&(std::size_t)>& map_of,
                                                const std::function<TileBaker()>& make_baker, const StopRequest& stop);

}  // namespace exitance

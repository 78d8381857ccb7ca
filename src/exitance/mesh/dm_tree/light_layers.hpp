#pragma once

#include "exitance/core/ids.hpp"
#include "exitance/core/spectrum.hpp"
#include "exitance/mesh/dm_tree/light_layer.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Direct light as one mesh for each source and surface, to be added up.
struct LightLayers {
    /// Of light whose colour is the same everywhere, one a source and region; else one a band.
    struct Sheet {
        RegionId region;
        std::uint32_t source = 0;  ///< Of `sources`.
        Spectrum colour;           ///< What a value of the layer counts.
        LightLayer light;
    };
    /// Regions that emit, each by itself; none, the last: what else shines, together.
    std::vector<RegionId> sources;
    std::vector<Sheet> sheets;  ///< By region, then by source.

    bool empty() const { return sources.empty(); }
    std::size_t size() const;          ///< Triangles that are stored.
    std::size_t memory_bytes() const;  ///< Of the compressed layers.
};

/// The sum of layers at a place.
class LayerFunction {
  public:
    /// `layers`, whose grids must be made, and `scene` must outlive it.
    LayerFunction(const LightLayers& layers, const Scene& scene);

    /// Irradiance, W/m^2; 0 where no layer has light.
    Spectrum at(RegionId region, const Point& p) const;

  private:
    const LightLayers* layers_;
    const Scene* scene_;
    std::vector<std::uint32_t> first_;  ///< By region, and one past the last.
};

/// A place of a region in the coordinates of its layers.
Vec2 layer_place(const Region& region, const Point& p);

}  // namespace exitance

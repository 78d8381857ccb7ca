#pragma once

#include "exitance/core/ids.hpp"
#include "exitance/core/spectrum.hpp"
#include "exitance/mesh/dm_tree/light_layer.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Direct light as one mesh per source and surface; the light is their sum.
struct LightLayers {
    /// One per source and region if the light has the same colour everywhere, otherwise one per band.
    struct Sheet {
        RegionId region;
        std::uint32_t source = 0;  ///< Index in `sources`.
        Spectrum colour;           ///< Light per unit of the layer's value.
        LightLayer light;
    };
    /// The emitting regions, each a source of its own. The last entry, none, represents all other emitters together.
    std::vector<RegionId> sources;
    std::vector<Sheet> sheets;  ///< Sorted by region, then by source.

    bool empty() const { return sources.empty(); }
    std::size_t size() const;          ///< Number of stored triangles.
    std::size_t memory_bytes() const;  ///< Memory of the compressed layers.
};

/// Evaluates the sum of the layers at a point.
class LayerFunction {
  public:
    /// `layers` (with grids made) and `scene` must outlive the object.
    LayerFunction(const LightLayers& layers, const Scene& scene);

    /// Irradiance, W/m^2; 0 where no layer has light.
    Spectrum at(RegionId region, const Point& p) const;

  private:
    const LightLayers* layers_;
    const Scene* scene_;
    std::vector<std::uint32_t> first_;  ///< Per region, and one past the last.
};

/// A point of a region in the coordinates of its layers.
Vec2 layer_place(const Region& region, const Point& p);

}  // namespace exitance

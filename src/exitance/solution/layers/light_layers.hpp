#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/solution/layers/light_layer.hpp"
#include "exitance/solution/solution.hpp"

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
    /// The emitting regions, each a source of its own. The last entries, none, represent all other emitters: one entry
    /// per light group, or a single one if the groups share materials or are too many.
    std::vector<RegionId> sources;
    std::vector<Sheet> sheets;        ///< Sorted by region, then by source.
    std::vector<std::string> groups;  ///< Light group of each source; empty if unknown, or if it has several.
    std::vector<double> factors;      ///< Factor by which each source is dimmed; 1 if it is missing.
    std::string mesh;                 ///< Options of the single mesh (`describe_mesh`); empty: it cannot be made.

    bool empty() const { return sources.empty(); }
    double factor(std::uint32_t source) const { return source < factors.size() ? factors[source] : 1.0; }
    std::size_t size() const;          ///< Number of stored triangles.
    std::size_t memory_bytes() const;  ///< Memory of the compressed layers.
};

/// The sum of all layers at a point of a region, whose grids must be made: irradiance, W/m^2.
Spectrum light_at(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p);

/// Like `light_at` above, for the layers of these sources only, which are indices in `sources`, ascending.
Spectrum light_at(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p,
                  std::span<const std::uint32_t> among);

/// Returns the sources that a word selects, as indices in `sources`, ascending: one by its number from 1, or all whose
/// material or group has this name; "others" selects the layers of all other emitters. Empty if there is none.
std::vector<std::uint32_t> named_sources(const LightLayers& layers, const Scene& scene, const std::string& word);

/// Layers as the engine evaluates and keeps them.
class LayersForm final : public LightForm {
  public:
    static constexpr std::string_view name = "layers";

    explicit LayersForm(LightLayers layers);

    std::string_view kind() const override { return name; }
    Spectrum at(const Scene& scene, RegionId region, const Point& x) const override {
        return light_at(layers_, scene, region, x);
    }
    std::size_t triangle_count() const override { return first_.back(); }
    QuadraticTriangle triangle(const Scene& scene, std::size_t i, const Spectrum& weight) const override;
    LightFormPointer dimmed(GroupFactors factors) const override;
    std::string packed() const override;
    static LightFormPointer unpack(std::string_view bytes);

    const LightLayers& layers() const { return layers_; }

  private:
    LightLayers layers_;
    std::vector<std::size_t> first_;  ///< Number of a sheet's first triangle; and one past the last.
};

/// The layers of a solution; empty ones where it has none.
const LightLayers& layers_of(const Solution& solution);

/// A point of a region in the coordinates of its layers.
Vec2 layer_place(const Region& region, const Point& p);

}  // namespace exitance

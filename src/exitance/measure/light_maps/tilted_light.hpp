#pragma once

#include <array>
#include <optional>
#include <span>

#include "exitance/measure/light_maps/curved_light.hpp"
#include "exitance/measure/light_maps/directed_irradiance.hpp"
#include "exitance/measure/pictures/tile_light.hpp"

namespace exitance {

/// Irradiance on tilted planes at the places of light maps, for normal maps. Planes are at points slightly above the
/// surface, as sensors that `probe` evaluates there; they also receive what the surface itself reflects.
///
/// Direct light is evaluated at five normals in one point of a texel, and in up to four if the first does not have the
/// texel's irradiance, as at shadow edges. Reflected light is gathered by rays at nodes of the chart at most
/// `node_texels` apart and interpolated; where all nodes around a texel are covered, at a place of its block. All nodes
/// use the same directions relative to their normals. The result is then constrained to the texel's irradiance.
///
/// A texel costs five to twenty times as much as direct light at a point, and 4 us for reflected light.
class TiltedLight {
  public:
    /// curved  places of curved regions; null: all regions are flat
    /// Keeps references to both.
    TiltedLight(const RadiosityFunction& light, const CurvedLight* curved, Component component, Directions form)
        : light_(light), curved_(curved), component_(component), form_(form) {}

    class Workspace;

    /// Starts a tile of a chart, whose first texel has coordinates that are multiples of `node_texels`.
    void start(const Chart& chart, int x, int y, Workspace& workspace) const;
    /// Returns the light of a texel (x, y) of the chart of the tile.
    /// open        uncovered places of the texel, at least one
    /// irradiance  the irradiance of the texel, W/m^2
    DirectedIrradiance at(int x, int y, std::span<const MeasuredPlace> open, const Spectrum& irradiance,
                          Workspace& workspace) const;

  private:
    using Known = std::optional<DirectedIrradiance>;
    ProbePoint above(const MeasuredPlace& place) const;
    DirectedIrradiance direct(const ProbePoint& at, Workspace& workspace) const;
    DirectedIrradiance gather(const ProbePoint& at, Workspace& workspace) const;
    const Known& node(int i, int j, Workspace& workspace) const;
    DirectedIrradiance reflected(int x, int y, const MeasuredPlace& place, Workspace& workspace) const;

    const RadiosityFunction& light_;
    const CurvedLight* curved_;
    Component component_;
    Directions form_;
};

/// Temporary storage; one per thread.
class TiltedLight::Workspace {
  private:
    friend TiltedLight;
    static constexpr int blocks = tile_side / node_texels, nodes = blocks + 1;

    const Chart* chart_ = nullptr;
    int x_ = 0, y_ = 0;                                      ///< First texel of the tile.
    std::array<std::optional<Known>, nodes * nodes> nodes_;  ///< No entry: not gathered yet; an empty entry: covered.
    std::array<Known, blocks * blocks> in_block_;            ///< Light at a place of a block whose nodes are covered.
    PlaceLight::Workspace direct_;
    GatherWorkspace gather_;
};

}  // namespace exitance

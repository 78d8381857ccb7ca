#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/measure/light_maps/light_map.hpp"

namespace exitance {

/// The part of a texel that has light of a curved surface.
struct CurvedTexel {
    float x = 0, y = 0;      ///< From the texel's centre to the middle of the points that were evaluated, texels.
    bool is_curved = false;  ///< False: a texel of a flat region, or of none.
};

/// Values of one map, in the order of its texels: W/m^2.
using TexelValues = std::vector<std::array<float, bands>>;

/// Evaluates light at the centres of texels that curved charts cover only in part, and of the ring of texels outside:
/// a plane is fitted to the computed texels of the chart in a square of five by five, each at the middle of its part.
/// Bilinear lookups at both sides of a border between two charts then agree up to second order. A texel keeps its
/// value, or stays empty, where the square has too few texels of the chart or a shadow edge. O(texels).
/// room    texels to change
/// curved  one per texel of the map
/// charts  the chart of each texel, which is set in the ring; empty: `room` has one chart
/// values  fields to change: light.irradiance, and others that depend on it linearly
void fit_curved_borders(const Chart::Rectangle& room, std::span<const CurvedTexel> curved,
                        std::span<std::uint32_t> charts, std::span<TexelValues* const> values, LightMap& light);

}  // namespace exitance

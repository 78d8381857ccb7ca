#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exitance/evaluate/mesh_light.hpp"
#include "exitance/measure/light_maps/chart.hpp"

namespace exitance {

/// Integrals over texels of the polynomials of a solution's discontinuity mesh or of the sum of its layers (MeshLight).
/// Exact up to rounding: triangles are clipped to texels, and the parts have a rule that is exact for the polynomial:
/// quadratic, or cubic on the thirds of Clough-Tocher elements. Triangles that are covered by other surfaces or inside
/// bodies (is_in_open, by their centroids) are not part of a texel.
class MeshTexels {
  public:
    /// Integral over one texel, whose area is 1.
    struct Integral {
        double open = 0, buried = 0;  ///< Areas of the uncovered and covered triangles in it.
        Spectrum light;               ///< Integral over the uncovered triangles, W/m^2.

        /// Mean over the uncovered part; none if the triangles leave more than a thousandth of `share`, the region's
        /// part of the texel, without triangles, or if nearly all of it is buried.
        std::optional<Spectrum> mean(double share) const;
    };

    /// Keeps references to all arguments. O(triangles x tiles that each touches), plus a few rays per triangle.
    MeshTexels(const MeshLight& light, const Stage& stage, std::span<const Chart> charts);

    /// Computes the integrals over the texels of a tile, row by row; none if there is no mesh. `rectangle` must start
    /// at multiples of tile_side and not be larger than a tile. O(texels that its triangles touch).
    void integrate(std::size_t chart, Chart::Rectangle rectangle, std::vector<Integral>& integrals) const;

    const MeshLight& light() const { return light_; }

  private:
    struct Part {
        std::array<Vec2, 3> corner;  ///< Positions in the chart.
        std::uint32_t triangle = 0;  ///< Index in the mesh or in the layers.
        bool is_of_layers = false;
        bool is_open = true;
        bool is_mirrored = false;  ///< Corners 1 and 2 are swapped, to be counter-clockwise.
    };
    void add_mesh_parts(const Stage& stage, std::span<const std::uint32_t> chart_of);
    void add_layer_parts(std::span<const std::uint32_t> chart_of);
    void sort_into_tiles();
    template <class Visit>
    void visit_tiles(std::size_t part, const Visit& visit) const;

    const MeshLight& light_;
    std::span<const Chart> charts_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> chart_of_part_;
    std::vector<std::size_t> first_tile_;  ///< First tile of each chart.
    std::vector<std::size_t> begin_;       ///< Start of each tile in `in_tile_`, and the end of the last one.
    std::vector<std::uint32_t> in_tile_;   ///< Indices of parts, tile by tile.
};

}  // namespace exitance

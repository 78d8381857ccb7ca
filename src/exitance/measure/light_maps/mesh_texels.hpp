#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exitance/evaluate/mesh_light.hpp"
#include "exitance/measure/light_maps/chart.hpp"

namespace exitance {

/// Integrals over texels of the polynomials that a solution's discontinuity mesh, or the sum of its layers, consists of
/// (MeshLight). Exact but for rounding: the triangles are cut along the borders of texels, and what is
/// left has a rule that is exact for its polynomial, quadratic or, on the thirds of Clough and Tocher's elements,
/// cubic. Triangles beneath other surfaces and within bodies (is_in_open, by their centroids) count as no part of a
/// texel.
class MeshTexels {
  public:
    /// Over one texel, its area being 1.
    struct Integral {
        double open = 0, buried = 0;  ///< Areas of the triangles in it.
        Spectrum light;               ///< Over the open ones, W/m^2.

        /// The mean over the open part; none where the triangles leave more than a thousandth of `share`, the region's
        /// part of the texel, uncovered, or nearly all of it is buried.
        std::optional<Spectrum> mean(double share) const;
    };

    /// Keeps references. O(triangles x tiles that each touches), beside a few rays a triangle.
    MeshTexels(const MeshLight& light, const Stage& stage, std::span<const Chart> charts);

    /// Integrals over the texels of a tile, row by row; none where there is no mesh. `rectangle` begins at multiples of
    /// tile_side and is no larger than that. O(texels that its triangles touch).
    void integrate(std::size_t chart, Chart::Rectangle rectangle, std::vector<Integral>& integrals) const;

    const MeshLight& light() const { return light_; }

  private:
    struct Part {
        std::array<Vec2, 3> corner;  ///< Places in the chart.
        std::uint32_t triangle = 0;  ///< Of the mesh or of the layers.
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
    std::vector<std::size_t> first_tile_;  ///< By chart.
    std::vector<std::size_t> begin_;       ///< By tile, in `in_tile_`; and one past the last.
    std::vector<std::uint32_t> in_tile_;   ///< Parts.
};

}  // namespace exitance

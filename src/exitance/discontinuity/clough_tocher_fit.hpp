#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/discontinuity/misfit.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"
#include "exitance/mesh/discontinuity/clough_tocher.hpp"

namespace exitance {

/// Clough and Tocher's elements through the values at a mesh's nodes. Slopes are estimated: of each triangle by the
/// cubic polynomial nearest to its thirteen values, for all triangles around a corner by the gradient nearest to
/// theirs. Corners are one where triangles meet across edges without a jump or kink. Beside a kink the gradients of
/// both sides differ, but not along it, so that light is continuous there; across an edge's middle each side has its
/// own slope. Cubic polynomials are reproduced; the error of smooth light falls with the fourth power of the triangles'
/// size. O(triangles).
class CloughTocherFit {
  public:
    /// `values`: at all nodes of the mesh, W/m^2; `normal`: of a triangle's region. Both are read while it is made, the
    /// mesh and the values later, too.
    CloughTocherFit(const BisectionMesh& mesh, std::span<const Spectrum> values,
                    const std::function<Normal(std::uint32_t)>& normal);

    CloughTocher element(std::uint32_t triangle, std::size_t band) const;
    /// By the values at the middles and quarters of edges and within.
    Misfit misfit(std::uint32_t triangle, const Spectrum& weight) const;
    /// Gives a mesh of the same triangles and corners its slopes, and the values at the middles of edges.
    void write(SixNodeMesh& out) const;

  private:
    /// Slopes of the cubic polynomial nearest to a triangle's values, times the ways that they are along.
    struct Slopes {
        std::array<std::array<Spectrum, 2>, 3> to_next;
        std::array<Spectrum, 3> across;
    };
    using Gradient = std::array<Vec3, bands>;
    struct Corner {
        std::uint32_t triangle, number;
    };

    void fit_triangles();
    void find_sectors();
    void fit_corners(std::span<const Corner> around, const Normal& n);
    void fit_edges();
    CloughTocher::Data corner_data(std::uint32_t triangle, std::size_t band) const;
    EdgeFrame frame(std::uint32_t triangle, std::size_t edge) const;
    bool is_smooth(std::uint32_t triangle, std::size_t edge) const;

    const BisectionMesh& mesh_;
    std::span<const Spectrum> values_;
    std::vector<Slopes> slopes_;                        ///< Of triangles.
    std::vector<std::array<std::uint32_t, 3>> sector_;  ///< Of triangles' corners.
    std::vector<Gradient> gradient_;                    ///< Of sectors, W/m^3.
    std::vector<std::array<Spectrum, 3>> inwards_;      ///< Of triangles, at the middles of edges, W/m^3.
};

}  // namespace exitance

#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/discontinuity/misfit.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"
#include "exitance/mesh/discontinuity/clough_tocher.hpp"

namespace exitance {

/// Clough-Tocher elements that interpolate the values at a mesh's nodes. The gradients are estimated from the values:
/// each triangle takes the slopes of the least-squares cubic polynomial through its thirteen values, and the triangles
/// around a corner share the gradient that fits their slopes best. A shared corner (a sector) is the set of triangle
/// corners at one node that are connected across edges without a jump or kink. The gradients on both sides of a kink
/// differ, but agree along it, so that light is continuous there; at the middle of such an edge each side has its own
/// slope across. Cubic polynomials are reproduced exactly; the error of smooth light falls with the fourth power of the
/// triangles' size. O(triangles).
class CloughTocherFit {
  public:
    /// `values`: irradiance at all nodes of the mesh, W/m^2. `normal`: normal of the region that a triangle belongs to,
    /// used only by the constructor. The mesh and the values must outlive the fit.
    CloughTocherFit(const BisectionMesh& mesh, std::span<const Spectrum> values,
                    const std::function<Normal(std::uint32_t)>& normal);

    CloughTocher element(std::uint32_t triangle, std::size_t band) const;
    /// Error of a triangle's element, measured at the middles and quarters of its edges and at its inner node.
    Misfit misfit(std::uint32_t triangle, const Spectrum& weight) const;
    /// Stores gradients and slopes in a mesh of the same triangles and corners, and sets the values at the middles of
    /// edges to those of the elements.
    void write(SixNodeMesh& out) const;

  private:
    /// Slopes of the cubic polynomial that fits a triangle's values best. Each is a derivative times the length of the
    /// way along which it is taken.
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
    std::vector<Slopes> slopes_;                        ///< Per triangle.
    std::vector<std::array<std::uint32_t, 3>> sector_;  ///< Per triangle and corner: the number of the sector.
    std::vector<Gradient> gradient_;                    ///< Gradient of the light per sector, W/m^3.
    /// Per triangle and edge: slope inwards at the edge's middle, W/m^3.
    std::vector<std::array<Spectrum, 3>> inwards_;
};

}  // namespace exitance

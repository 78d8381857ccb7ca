#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// Error of a triangle's polynomial.
struct Misfit {
    double squared = 0;  ///< Area times the mean square error, W^2/m^2.
    double largest = 0;  ///< Largest error, W/m^2.
};

/// Measures the error of a triangle's quadratic polynomial at the quarters of its edges and at its inner node. A cubic
/// error vanishes at the six nodes: its mean square is the sum over its components x (1 - x) (x - 1/2) along the edges
/// and the bubble function inside.
/// values   irradiance at the mesh's nodes, W/m^2
/// weight   factor by which an error counts, per band
Misfit misfit(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
              const Spectrum& weight);

/// Largest difference between light at the middles of a triangle's edges and linear interpolation of its corners,
/// W/m^2. Needs only the six nodes of the polynomial.
double bend(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
            const Spectrum& weight);

/// Limits on the misfits of a mesh.
struct MisfitLimits {
    double squared = 0;          ///< Limit on the sum of `Misfit::squared` over all triangles, W^2/m^2.
    double largest = 0;          ///< Limit on `Misfit::largest`, W/m^2, except for `unfindable_area`.
    double unfindable_area = 0;  ///< Total area of the triangles on which `largest` may be exceeded, m^2.
    double shortest_edge = 0;    ///< Triangles without a longer edge are never bisected, metres.
    double tried_area = 0;       ///< Larger triangles are tested even if they are flat, m^2.
};

/// True if a triangle is so flat that it need not be tested at more than its six nodes. Light between curves is smooth,
/// and in a small flat triangle each order of its expansion is smaller than the one before. The error of the quadratic
/// polynomial is thus below the bend, which may be up to half of either limit. `bend`: W/m^2; `area`: m^2; `triangles`:
/// number of triangles of the mesh.
bool is_flat(double bend, double area, std::size_t triangles, const MisfitLimits& limits);

/// Returns the triangles to bisect: those with more than their share of the squared error while the sum is above its
/// limit, and those above the largest error, except for the smallest ones (`unfindable_area`). The share shrinks as the
/// sum grows beyond the limit, since one bisection removes most of a triangle's squared error. O(n log n).
std::vector<std::uint32_t> coarse_triangles(const BisectionMesh& mesh, std::span<const Misfit> misfits,
                                            const MisfitLimits& limits);

/// Which triangles of a mesh have been tested at more than the nodes of their polynomials, and the resulting misfits.
/// Flat triangles are not tested; their misfit is recorded as 0.
class TriedTriangles {
  public:
    /// Resets the triangles that have changed since the last call. Returns the nodes of their polynomials.
    std::vector<std::uint32_t> forget_changed(BisectionMesh& mesh);

    /// Returns the triangles that have to be tested: those that have not been and are not flat (is_flat) in the present
    /// mesh.
    std::vector<std::uint32_t> untried(const BisectionMesh& mesh, std::span<const Spectrum> values,
                                       const std::function<Spectrum(std::uint32_t triangle)>& weight,
                                       const MisfitLimits& limits) const;
    /// Returns the nodes at which these triangles are tested.
    static std::vector<std::uint32_t> places(const BisectionMesh& mesh, std::span<const std::uint32_t> triangles);

    void set(std::uint32_t triangle, const Misfit& misfit) { misfits_[triangle] = misfit, is_tried_[triangle] = 1; }
    std::span<const Misfit> misfits() const { return misfits_; }

  private:
    std::vector<Misfit> misfits_;
    std::vector<std::uint8_t> is_tried_;
};

}  // namespace exitance

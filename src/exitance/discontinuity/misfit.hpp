#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// How far a triangle's polynomial is off.
struct Misfit {
    double squared = 0;  ///< Area times the mean square, W^2/m^2.
    double largest = 0;  ///< W/m^2
};

/// By the values at quarters of edges and within. A cubic error vanishes at the nodes: its mean square is that of its
/// parts x (1 - x) (x - 1/2) along the edges and of the bubble within.
/// values   irradiance at the mesh's nodes, W/m^2
/// weight   what it counts
Misfit misfit(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
              const Spectrum& weight);

/// How far light at the middles of a triangle's edges is off the linear function of its corners, at most, W/m^2. The
/// six nodes of the polynomial are all it takes.
double bend(const BisectionMesh& mesh, std::uint32_t triangle, std::span<const Spectrum> values,
            const Spectrum& weight);

/// What misfits may be.
struct MisfitLimits {
    double squared = 0;          ///< Sum over all triangles, W^2/m^2.
    double largest = 0;          ///< W/m^2, but for triangles that together are
    double unfindable_area = 0;  ///< so large, m^2.
    double shortest_edge = 0;    ///< Metres: what has no longer one is never too coarse.
    double tried_area = 0;       ///< m^2: what is larger is never too flat to be tried.
};

/// Is a triangle of an area (m^2), one of so many, too flat to be tried at more places than its nodes? Light between
/// curves is smooth, and each order of its expansion is smaller than the one before where a triangle is small enough to
/// be flat: what the quadratic polynomial misses is less than the bend, which has half of either limit here.
bool is_flat(double bend, double area, std::size_t triangles, const MisfitLimits& limits);

/// Triangles that are to be bisected: those with more than their share of the squares while these are too many (a
/// larger share the farther off they are, since most of it falls at once), and those that miss the largest error, the
/// smallest left out. O(n log n).
std::vector<std::uint32_t> coarse_triangles(const BisectionMesh& mesh, std::span<const Misfit> misfits,
                                            const MisfitLimits& limits);

/// Which triangles of a mesh have been tried at more places than the nodes of their polynomials, and with what result.
/// Flat ones are not: nothing is known of them but that they are, and their misfits are 0.
class TriedTriangles {
  public:
    /// Begins again with the triangles that have changed. Returns the nodes of their polynomials.
    std::vector<std::uint32_t> forget_changed(BisectionMesh& mesh);

    /// Triangles that are to be tried, since they are not flat (is_flat), or no longer flat enough.
    std::vector<std::uint32_t> untried(const BisectionMesh& mesh, std::span<const Spectrum> values,
                                       const std::function<Spectrum(std::uint32_t triangle)>& weight,
                                       const MisfitLimits& limits) const;
    /// The places at which these are tried.
    static std::vector<std::uint32_t> places(const BisectionMesh& mesh, std::span<const std::uint32_t> triangles);

    void set(std::uint32_t triangle, const Misfit& misfit) { misfits_[triangle] = misfit, is_tried_[triangle] = 1; }
    std::span<const Misfit> misfits() const { return misfits_; }

  private:
    std::vector<Misfit> misfits_;
    std::vector<std::uint8_t> is_tried_;
};

}  // namespace exitance

#pragma once

#include <span>
#include <vector>

#include "exitance/core/spectrum.hpp"
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

/// What misfits may be.
struct MisfitLimits {
    double squared = 0;          ///< Sum over all triangles, W^2/m^2.
    double largest = 0;          ///< W/m^2, but for triangles that together are
    double unfindable_area = 0;  ///< so large, m^2.
    double shortest_edge = 0;    ///< Metres: what has no longer one is never too coarse.
};

/// Triangles that are to be bisected: those with more than their share of the squares while these are too many (a
/// larger share the farther off they are, since most of it falls at once), and those that miss the largest error, the
/// smallest left out. O(n log n).
std::vector<std::uint32_t> coarse_triangles(const BisectionMesh& mesh, std::span<const Misfit> misfits,
                                            const MisfitLimits& limits);

}  // namespace exitance

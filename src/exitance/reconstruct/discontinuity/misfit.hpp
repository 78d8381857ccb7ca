#pragma once

#include <span>

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

}  // namespace exitance

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Irradiance as the shading network of growing cells holds it: one Gaussian a unit, which lies near a surface and
/// faces as the surface does. The network's triangles lie in no polygon. With it goes the kernel network, for pictures
/// and studies. Evaluated by `CellFunction`.
struct CellLight {
    /// A unit of the shading network.
    struct Cell {
        Point at;                       ///< metres
        Normal n;                       ///< Which way its surface faces.
        double width = 0;               ///< d of exp(-r^2 / d^2), metres.
        Spectrum value;                 ///< Its output, W/m^2,
        std::array<Spectrum, 3> slope;  ///< and how that changes along x, y and z, W/m^3.
    };
    /// A unit of the kernel network: light that goes from y to x.
    struct Ray {
        Point x, y;
        double width = 0;  ///< metres
        Spectrum value;    ///< Kernel times exitance, W/m^4; visibility, without unit, where that is learned.
    };

    /// Weights are divided by their sum, and slopes count; else outputs are summed as they are.
    bool normalised = true;
    std::vector<Cell> cells;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Of the shading network.
    std::vector<Ray> kernel;
    std::vector<std::array<std::uint32_t, 2>> kernel_edges;
};

}  // namespace exitance

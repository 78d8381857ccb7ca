#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "exitance/base/spectrum.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Irradiance in the shading network of growing cells: one Gaussian per unit, located near a surface and with its
/// normal. The network's triangles do not coincide with polygons. The kernel network is included for pictures and
/// studies. Evaluated by `CellFunction`.
struct CellLight {
    /// A unit of the shading network.
    struct Cell {
        Point at;                       ///< metres
        Normal n;                       ///< Normal of its surface.
        double width = 0;               ///< d in exp(-r^2 / d^2), metres.
        Spectrum value;                 ///< Output of the cell, W/m^2.
        std::array<Spectrum, 3> slope;  ///< Derivatives of the output along x, y and z, W/m^3.
    };
    /// A unit of the kernel network: light from y to x.
    struct Ray {
        Point x, y;
        double width = 0;  ///< metres
        Spectrum value;    ///< Kernel times exitance, W/m^4; if visibility is learned instead: without unit.
    };

    /// True if weights are divided by their sum and slopes are used; otherwise outputs are summed.
    bool normalised = true;
    std::vector<Cell> cells;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Triangles of the shading network.
    std::vector<Ray> kernel;
    std::vector<std::array<std::uint32_t, 2>> kernel_edges;
};

}  // namespace exitance

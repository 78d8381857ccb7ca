#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Emitted flux against absorbed flux int (1 - rho) E dA: direct light by the projection's exact means, indirect light
/// by the solution's elements, both by a discontinuity mesh where there is one; and what escapes, by rays from
/// surfaces: of emitters that are not diffuse by their profiles. Nothing is forced to agree. O(elements).
EnergyBalance energy_balance(const Solution& solution, const DirectProjection& direct, const Stage& stage);

/// The same where nothing was projected: the emitted flux is read at the pieces.
EnergyBalance energy_balance(const Solution& solution, const Stage& stage);

/// The same of what is exported, which holds all light; of scenes that no light comes to from outside.
EnergyBalance energy_of_interpolant(const Solution& solution, const Stage& stage);

/// Means over all surfaces and bands, W/m^2.
struct DirectMeans {
    double arriving = 0;   ///< Of E_dir,
    double reflected = 0;  ///< and of rho E_dir.

    /// The mean that errors of direct light alone are relative to: of B - M, or of E if nothing reflects.
    double of_errors() const { return reflected > 0 ? reflected : arriving; }
};
DirectMeans mean_direct_light(const Stage& stage, const DirectProjection& direct);

}  // namespace exitance

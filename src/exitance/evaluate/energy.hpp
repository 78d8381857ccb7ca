#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Compares emitted flux with absorbed flux, int (1 - rho) E dA, and escaping flux. Direct light is taken from the
/// projection's exact means, indirect light from the solution's elements, or both from a discontinuity mesh if there is
/// one. Escaping light is estimated by rays from surfaces, and from lights without extent; for emitters that are not
/// diffuse, by their profiles.
/// Nothing is adjusted to agree. O(elements + rays).
EnergyBalance energy_balance(const Solution& solution, const DirectProjection& direct, const Stage& stage);

/// Like the above, for solutions without a projection: the emitted flux is taken from the pieces.
EnergyBalance energy_balance(const Solution& solution, const Stage& stage);

/// Energy balance of the exported interpolant, which contains all light. The light of sky and sun that arrives is
/// estimated at some thousands of places, to about 1%.
EnergyBalance energy_of_interpolant(const Solution& solution, const Stage& stage);

/// Means over all surfaces and bands, W/m^2.
struct DirectMeans {
    double arriving = 0;   ///< Mean of E_dir.
    double reflected = 0;  ///< Mean of rho E_dir.

    /// Mean to which errors of direct light alone are relative: that of B - M, or of E if nothing reflects.
    double of_errors() const { return reflected > 0 ? reflected : arriving; }
};
DirectMeans mean_direct_light(const Stage& stage, const DirectProjection& direct);

/// True if a ray from an emitting face or from a lamp without extent meets the back of a face. If all light of a scene
/// is lost, its faces may then be turned the wrong way; otherwise there is nothing that it could reach. Some rays for
/// every emitter.
bool shines_on_backs(const Stage& stage);

}  // namespace exitance

#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// Ratio of light without the scaling that conserves energy to light with it, per band: for projected direct light, and
/// for the indirect light of a solution, E_ind + c E_dir.
struct UnscaledShare {
    Spectrum direct{1.0}, indirect{1.0};
};

/// 1 / s per band.
Spectrum inverse(const Spectrum& s);

/// Ratio, without and with scaling, of the power that a method's light sends, rho (E_dir + E_ind) + c M, which a local
/// pass gathers. E_dir is multiplied by `direct`, E_ind by `direct` and `returned`. 1 if nothing is sent.
Spectrum unscaled_sent(const Scene& scene, const GlobalLight& light, const Spectrum& direct, const Spectrum& returned,
                       const Spectrum& c);

/// Energy defect of a solution, |emitted - absorbed - escaped| / emitted, without scaling: the absorbed power is
/// reduced by the part that scaling added, to first order; the escaped power is unchanged. Direct light of a
/// discontinuity mesh is not scaled. `energy`: balance with scaling. O(elements).
double energy_defect_before(const EnergyBalance& energy, const Solution& solution, const DirectProjection& direct,
                            const UnscaledShare& unscaled);

}  // namespace exitance

#pragma once

#include "exitance/solution/solution.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

/// What light would be had nothing been scaled to keep the energy balance, by what it is, a value a band: direct light
/// as projected, and the indirect light of a solution, E_ind + c E_dir.
struct UnscaledShare {
    Spectrum direct{1.0}, indirect{1.0};
};

/// 1 / s, band by band.
Spectrum inverse(const Spectrum& s);

/// The same of the power that a method's light sends, rho (E_dir + E_ind) + c M, which is what a local pass gathers,
/// where E_dir is to be multiplied by `direct` and E_ind by `direct` and `returned`. 1 where nothing is sent.
Spectrum unscaled_sent(const Scene& scene, const GlobalLight& light, const Spectrum& direct, const Spectrum& returned,
                       const Spectrum& c);

/// The energy defect of a solution, |emitted - absorbed - escaped| / emitted, had nothing been scaled: the absorbed
/// power is less by what scaling added to it, to first order in that; what escapes is as it is. Direct light of a
/// discontinuity mesh is not scaled. `energy` is the balance as it is. O(elements).
double energy_defect_before(const EnergyBalance& energy, const Solution& solution, const DirectProjection& direct,
                            const UnscaledShare& unscaled);

}  // namespace exitance

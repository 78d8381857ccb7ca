#pragma once

#include "exitance/mesh/element_locator.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Finds how much of the emitters' light is best gathered together with the reflected light b. Among the functions b +
/// c M the variance over the rays of a gather is least for
///
///     c = -Cov(b, M) / Var(M),
///
/// one value per band. Both moments are taken over the rays of one point and averaged over points. A function with less
/// variance is gathered with less noise and interpolated with less error: E_ind = H (b + c M) - c E_dir, with exact
/// E_dir. This is a control variate [Glasserman03]. c is 0 if it would not remove three quarters of the variance, since
/// E_dir may have shadow edges that E_ind does not have. If all surfaces of a closed room emit, c is near 1; in a
/// furnace it removes all variance.
/// `locator`: of light's tree. Casts 8192 rays if emitters are at least a twentieth of all surface area; otherwise
/// returns 0.
Spectrum find_direct_share(const Stage& stage, const GlobalLight& light, const ElementLocator& locator,
                           std::uint64_t seed);

}  // namespace exitance

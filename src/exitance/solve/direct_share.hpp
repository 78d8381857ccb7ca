#pragma once

#include "exitance/mesh/element_locator.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// How much of the emitters' light is best gathered along with the reflected light b. Of all functions b + c M the one
/// that varies least among the rays of a gather has
///
///     c = -Cov(b, M) / Var(M),
///
/// a value a band, both taken over the rays of one point and then averaged over points. What varies less is gathered
/// with less noise and interpolated with less error: E_ind = H (b + c M) - c E_dir, with E_dir exact. A control variate
/// [Glasserman03]; 0 where it would not take away three quarters of the variance, since E_dir may have shadow edges
/// that E_ind has not. Where all surfaces of a closed room glow c comes near 1, and in a furnace nothing is left to
/// vary. `locator` is that of light's tree. 8192 rays where emitters are a twentieth of all surface or more, else none.
Spectrum find_direct_share(const Stage& stage, const GlobalLight& light, const ElementLocator& locator,
                           std::uint64_t seed);

}  // namespace exitance

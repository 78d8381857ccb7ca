#pragma once

#include "exitance/methods/methods.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Solves b = rho (E_dir + F b) on the constant elements of `light.numbering`, for all reflections or `options.bounces`
/// of them. `light.direct` holds the mean direct light of each element, W/m^2. Starts from `light.reflected` unless
/// that is empty. Writes b to `light.reflected`, the light that arrives before the last reflection to `light.indirect`,
/// and the report and memory of F to `light`.
///
/// If `light.kept` is given, F is scaled so that it loses no light except light that escapes (`ConservingTransport`).
///
/// If surfaces emit all over the scene, direct light found by the rays of F replaces a share of the exact direct light
/// (`light.direct_share`). The noise of F then affects only the variation of reflected plus emitted light.
void relax_constant_elements(const MethodInput& input, const TransportOperator& F, GlobalLight& light);

/// Returns `GlobalLight::kept` for rows of rays, or nothing if it cannot be determined: rays of a diffusing pane leave
/// from both sides whereas its own light leaves from one, so they are meaningful only if all light arrives. Nor through
/// coloured glass, which keeps another share of every band.
std::vector<double> kept_light(const RayRows& rows, const Stage& stage);

}  // namespace exitance

#pragma once

#include "exitance/methods/methods.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// b = rho (E_dir + F b) on the constant elements of `light.numbering`, from `light.direct`, the mean direct light of
/// each: all reflections, or as many as were asked for. Writes b to `light.reflected`, the light that arrives before
/// the last reflection to `light.indirect`, the report, and what F takes. Starts from `light.reflected`, where that is
/// there.
///
/// Where `light.kept` is known, F is scaled to lose no light but what escapes (`ConservingTransport`).
///
/// Where surfaces glow all over, the direct light that F finds by its own rays takes a share of the exact one's place
/// (`light.direct_share`): then the noise of F meets only what varies of reflected and emitted light together.
void relax_constant_elements(const MethodInput& input, const TransportOperator& F, GlobalLight& light);

/// `GlobalLight::kept` by rows of rays. Those of a diffusing pane leave by both sides, where its own light leaves by
/// one: they tell how much arrives only where all does.
std::vector<double> kept_light(const RayRows& rows, const Scene& scene);

}  // namespace exitance

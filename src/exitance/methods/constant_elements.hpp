#pragma once

#include "exitance/methods/methods.hpp"

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

}  // namespace exitance

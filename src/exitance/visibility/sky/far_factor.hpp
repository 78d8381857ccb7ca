#pragma once

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Returns the cached form factor of an unoccluded part of the sky (one of `occluders.distant_pieces()`) at surfaces
/// with normal n, per thread. Negative: not computed yet; the caller must store it through the reference.
///
/// The factor depends only on the sky and on n, so one integral serves all elements with the same normal; for a sky
/// with strong gradients the integral takes about 0.1 ms. Entries are looked up by value, not by address, so results do
/// not depend on what the thread computed before. Remembers 64 directions. O(domes).
double& known_far_factor(const Occluders& occluders, PieceId part, const Normal& n);

}  // namespace exitance

#pragma once

#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Memory of one thread for the form factor of a part of the sky (one of `occluders.distant_pieces()`) that nothing
/// hides, at surfaces that face along `n`. Below 0: not known yet, to be set by the caller.
///
/// The factor depends on the sky and on n alone, so that one integral serves all elements that face one way: the
/// integral of a sky that varies fast takes about 0.1 ms. It is found again by the values that it depends on, never by
/// addresses; hence results do not depend on what a thread did before. 64 directions are remembered. O(domes).
double& known_far_factor(const Occluders& occluders, PieceId part, const Normal& n);

}  // namespace exitance

#pragma once

#include <span>
#include <vector>

#include "exitance/base/loop_progress.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Finds leaves that are wider than the gap in front of them: at some point of the leaf another surface is in front of
/// it, nearer than the leaf's width. Light varies there over a distance like the height of the gap, which a polynomial
/// of the leaf's size cannot represent. All such places together may be too small to be sampled by points spread by
/// area. A surface that touches the leaf is not a gap (`ContactLines`).
/// Returns 1 for such leaves, 0 for others and for inner elements. Deterministic on any number of threads. O(leaves):
/// four rays each.
Field<ElementId, std::uint8_t> find_narrow_leaves(const Stage& stage, const ElementTree& tree);

/// True for a leaf that find_narrow_leaves() would find. Four rays.
bool is_narrow_leaf(const Stage& stage, const ElementTree& tree, ElementId e);

/// For each of some leaves, returns how much of a pattern in the light that it reflects arrives unsmoothed: the squared
/// contrast of a pattern as wide as the leaf where the light arrives, as a share of that on the leaf. Near 0 for a leaf
/// of a wall, 1 in a gap far narrower than the leaf, and in between beside an edge where two surfaces meet. Eight rays
/// each, shared by processes, so that a single value may be off by a fifth.
///
/// Between parallel planes at the distance d, a wave of length h keeps the share x K1(x) of its contrast, x = 2 pi d/h:
/// the Fourier transform of the kernel d^2 / (pi (r^2 + d^2)^2). The lengths of the rays take the place of d, which is
/// a guess: surfaces need not be parallel. `part` counts the leaves.
std::vector<float> unsmoothed_shares(const Stage& stage, const ElementTree& tree, std::span<const ElementId> leaves,
                                     const StopRequest& stop, PhasePart part = {});

struct DirectProjection;

/// Share of the reflected direct light that comes from leaves of the projection's mesh that are more than twice as wide
/// as the gap in front of them is high: large between the slats of a blind, zero in an ordinary room. Light reflected
/// in a gap returns from its other side before distance smooths it. Estimated from some thousand leaves at even steps,
/// with four rays each.
double share_of_light_in_gaps(const Stage& stage, const DirectProjection& direct);

}  // namespace exitance

#pragma once

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

struct DirectProjection;

/// Share of the reflected direct light that comes from leaves of the projection's mesh that are more than twice as wide
/// as the gap in front of them is high: large between the slats of a blind, zero in an ordinary room. Light reflected
/// in a gap returns from its other side before distance smooths it. Estimated from some thousand leaves at even steps,
/// with four rays each.
double share_of_light_in_gaps(const Stage& stage, const DirectProjection& direct);

}  // namespace exitance

#pragma once

#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// The form factor to the visible part of a source by its boundary alone: no polygon is cut.
///
///     F = 1/(2 pi) sum over boundary pieces of  g  n . (b x a)
///
/// The boundary consists of the source's edges where no occluder hides their inner side, and of the occluders' edges,
/// reversed, within the source and where no other occluder hides their outer side. An edge and a convex occluder meet
/// in one interval, so each edge is left with the complement of a union of intervals. Of edges that coincide, one
/// speaks: those with occluders on both sides are inside, those with two occluders on one side belong to the first.
/// Source: [Stark00] and the silhouette counts of [Laine05], per convex occluder. O(e k) for e edges and k occluders.
///
/// Takes what visible_form_factor leaves in `scratch` (source, shadows and their outlines). Returns NaN if the pieces
/// do not close to loops: rounding decided coincident edges inconsistently, and the source is to be cut instead.
double edge_sum(const Normal& n, VisibilityWorkspace& scratch);

}  // namespace exitance

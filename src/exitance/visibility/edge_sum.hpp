#pragma once

#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Form factor to the visible part of a source from its boundary alone, without polygon clipping.
///
///     F = 1/(2 pi) sum over boundary pieces of  g  n . (b x a)
///
/// The boundary consists of the source's edges where no occluder hides their inner side, and of the occluders' edges
/// (reversed) inside the source where no other occluder hides their outer side. An edge and a convex occluder overlap
/// in one interval, so the visible part of each edge is the complement of a union of intervals. Coincident edges are
/// counted once: an edge with occluders on both sides is interior; of two occluders on the same side, the first owns
/// the edge. Source: [Stark00] and the silhouette counts of [Laine05], per convex occluder. O(e k) for e edges and k
/// occluders.
///
/// Requires the contents of `scratch` (source, shadows and their outlines) as visible_form_factor() leaves them.
/// Returns NaN if the boundary pieces do not form closed loops because rounding classified coincident edges
/// inconsistently; the caller must then clip the source instead.
double edge_sum(const Normal& n, VisibilityWorkspace& scratch);

}  // namespace exitance

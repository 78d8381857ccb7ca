#pragma once

#include <optional>
#include <span>

#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Form factor from a receiver to the visible part of a source, weighted by what panes of glass let through:
///
///     F = integral over the visible part of  T p dF,     T the product over the panes that the way crosses.
///
/// The source is cut along the outlines of the panes as seen from the receiver, and cut further until T is even over
/// each part (to 0.04, which the middle's value leaves 1e-3 of). Visibility within each part is exact. `candidates`: as
/// of visible_form_factor, or none: all occluders.
Spectrum glazed_form_factor(const Occluders& occluders, const Receiver& at, PieceId source,
                            std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                            const PartLight& light);

/// What the panes between two points let through of light that goes from one to the other.
Spectrum transmission_between(std::span<const Pane> panes, const Point& x, const Point& y);

/// Of visible_form_factor for a part of a source: a convex polygon in its plane, relative to the receiver, within it
/// and above the receiver's horizon.
double visible_form_factor_of_part(const Occluders& occluders, const Receiver& at, PieceId source,
                                   std::span<const Vec3> part, std::optional<std::span<const PieceId>> candidates,
                                   VisibilityWorkspace& scratch, const PartLight& light);

/// The source as seen from the receiver, relative to it, above its horizon; empty where it is turned away.
std::vector<Vec3> source_above_horizon(const Occluders& occluders, const Receiver& at, PieceId source,
                                       VisibilityWorkspace& scratch);

}  // namespace exitance

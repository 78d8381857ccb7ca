#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Form factor from a receiver to the visible part of a source, weighted by what panes of glass let through:
///
///     F = integral over the visible part of  T p dF,     T the product over the panes that the way crosses.
///
/// The visible part is cut along the outlines of the panes as seen from the receiver, and cut further until T is even
/// over each part, to 0.04 of itself in each band, and its mean is that of the corners and the middle as p dF weighs
/// them: 1e-3 at most. `candidates`: as of visible_form_factor, or none: all occluders.
Spectrum glazed_form_factor(const Occluders& occluders, const Receiver& at, PieceId source,
                            std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                            const PartLight& light);

/// What the panes between two points let through of light that goes from one to the other.
Spectrum transmission_between(std::span<const Pane> panes, const Point& x, const Point& y);

/// The same for a convex polygon that is visible: in the source's plane, relative to the receiver.
Spectrum transmitted_form_factor(const Occluders& occluders, const Receiver& at, PieceId source,
                                 std::span<const Vec3> visible, const RelativeRadiance& radiance);

/// Convex polygons in the plane of a source, relative to the receiver, that together are its visible part.
using Fragments = std::vector<std::vector<Vec3>>;
void visible_fragments(const Occluders& occluders, const Receiver& at, PieceId source,
                       std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                       Fragments& out);

}  // namespace exitance

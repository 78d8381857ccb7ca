#pragma once

#include <optional>
#include <span>
#include <vector>

#include "exitance/visibility/visible_part.hpp"

namespace exitance {

/// Form factor from a receiver to the visible part of a source, weighted by the transmission of the glass panes in
/// between:
///
///     F = integral over the visible part of  T p dF,     T = product of the transmissions of all panes crossed.
///
/// The own pane of a window (`Occluders::windows`) does not count; those behind it do. The visible part is cut along
/// the outlines of the panes as seen from the receiver. Each part is subdivided until T varies by at most 4% in each
/// band. Its mean T is that of the corners and the middle, weighted by p dF. Error: at most 1e-3.
/// candidates  possible occluders, as for visible_form_factor(); none: all occluders
Spectrum glazed_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                            std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                            const PartLight& light);

/// Returns whether the segment from x to y crosses a pane.
bool crosses(const Pane& pane, const Point& x, const Point& y);

/// Transmission of the panes between two points.
Spectrum transmission_between(std::span<const Pane> panes, const Point& x, const Point& y);

/// Like glazed_form_factor(), for a given visible convex polygon in the source's plane, relative to the receiver.
Spectrum transmitted_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                                 std::span<const Vec3> visible, const RelativeRadiance& radiance);

/// Convex polygons in the plane of a source, relative to the receiver, whose union is the visible part of the source.
using Fragments = std::vector<std::vector<Vec3>>;
void visible_fragments(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                       std::optional<std::span<const PieceId>> candidates, VisibilityWorkspace& scratch,
                       Fragments& out);

}  // namespace exitance

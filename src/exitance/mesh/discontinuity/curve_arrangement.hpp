#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {

/// A straight segment on a receiver, in the receiver's plane coordinates, metres.
struct FlatCurve {
    Vec2 a, b;
    CurveOrder order = CurveOrder::d1;
    CurveCause cause = CurveCause::contact;
    RegionId source;
    /// Upper bound of the change of light across it, W/m^2.
    double gain = 0;

    double length() const { return std::hypot(b.x - a.x, b.y - a.y); }  ///< m
    /// Returns the gain times the length, W/m: of too many curves, those with the largest effect are kept.
    double effect() const { return gain * length(); }
};

/// Prepares curves for cutting. Lines nearer than `tolerance` become one. Of overlapping segments the strongest is
/// kept. Segments are clipped to the polygon; those on its border are removed. Ends nearer than the tolerance to each
/// other or to a line are merged with them. The order of the result depends on the input only.
/// loops  outer loops and holes of the polygon, in any order
/// tolerance  metres
/// Ends of curves on the border become corners of the returned loops.
/// O(n log n + n (border edges) + near pairs).
struct ArrangedCurves {
    std::vector<FlatCurve> curves;
    std::vector<std::vector<Vec2>> loops;
};
ArrangedCurves arranged_curves(std::vector<FlatCurve> curves, std::span<const std::vector<Vec2>> loops,
                               double tolerance);

}  // namespace exitance

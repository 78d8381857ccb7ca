#pragma once

#include <span>
#include <vector>

#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {

/// A stretch of a straight line on a receiver, in the receiver's own coordinates, metres.
struct FlatCurve {
    Vec2 a, b;
    CurveOrder order = CurveOrder::d1;
    CurveCause cause = CurveCause::contact;
    RegionId source;
    double gain = 0;  ///< How much light it may change, W/m^2: of many, those with the most are kept.
};

/// Curves made ready to be cut along: lines nearer than `tolerance` (metres) become one, of stretches that lie on one
/// another the strongest is kept, each ends at the polygon's border, those on the border go, and ends nearer than the
/// tolerance to one another or to a line become one place. In an order that follows from the input alone.
/// loops    outer loops and holes of the polygon, in any order
/// Ends on the border become corners of the loops that are returned.
/// O(n log n + n (border edges) + near pairs).
struct ArrangedCurves {
    std::vector<FlatCurve> curves;
    std::vector<std::vector<Vec2>> loops;
};
ArrangedCurves arranged_curves(std::vector<FlatCurve> curves, std::span<const std::vector<Vec2>> loops,
                               double tolerance);

}  // namespace exitance

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// The constrained Delaunay triangulation of a polygon with holes: triangles of corners that hold every border edge and
/// have, of all such, the largest smallest angle. Exact predicates. Source: [CGAL].
/// loops    outer loops and holes in any order and direction; they may touch but not cross
/// returns  corners of triangles as numbers into the loops put end to end, counter-clockwise; where several corners
///          stand at one place, the first of them. Empty when the loops enclose nothing. O(n log n).
std::vector<std::array<std::uint32_t, 3>> delaunay_triangles(std::span<const std::vector<Vec2>> loops);

/// A straight line to be kept as edges. Of edges that several lie on, the smallest label counts.
struct LabelledSegment {
    Vec2 a, b;
    std::uint8_t label = 0;
};

/// Triangles over a polygon with lines in it.
struct LabelledTriangles {
    static constexpr std::uint8_t unlabelled = 255, border = 0;
    static constexpr std::uint32_t none = 0xffffffffu;
    std::vector<Vec2> points;
    std::vector<std::array<std::uint32_t, 3>> corners;    ///< Counter-clockwise.
    std::vector<std::array<std::uint8_t, 3>> labels;      ///< Of the edge from corner i to the next.
    std::vector<std::array<std::uint32_t, 3>> neighbors;  ///< Across that edge, or none.
};

/// The same with segments that are kept as edges, too, wherever they cross, touch, overlap or leave the polygon. The
/// border has the label `border`. What exact predicates find of crossings is exact; places of crossings are rounded.
/// Empty when CGAL gives up, or when the loops enclose nothing. O((n + crossings) log n) as a rule.
LabelledTriangles labelled_triangles(std::span<const std::vector<Vec2>> loops,
                                     std::span<const LabelledSegment> segments);

/// The same triangles with points added until no angle is below 20.7 degrees, but for those between two labelled edges
/// and where what is to be added stood too near to what there is: Delaunay refinement. Labelled edges are halved where
/// a circle's middle lies behind them or in the circle over them. Source: [Ruppert95].
/// At most about 20 triangles for one of `coarse`, which come back as they are where CGAL gives up.
LabelledTriangles refined_triangles(const LabelledTriangles& coarse);

}  // namespace exitance

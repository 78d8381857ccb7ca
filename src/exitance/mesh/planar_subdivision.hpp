#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/vec.hpp"

namespace exitance {

/// Constrained Delaunay triangulation of a polygon with holes: it contains all border edges and, subject to that,
/// maximizes the smallest angle. Exact predicates. Source: [CGAL].
/// loops    outer loops and holes in any order and direction; they may touch but not cross
/// Returns the corners of the triangles, counter-clockwise, as indices into the concatenated loops (the first index, if
/// several corners coincide); empty if the loops enclose nothing. O(n log n).
std::vector<std::array<std::uint32_t, 3>> delaunay_triangles(std::span<const std::vector<Vec2>> loops);

/// A straight segment that becomes edges of a triangulation. An edge on several segments gets the smallest label.
struct LabelledSegment {
    Vec2 a, b;
    std::uint8_t label = 0;
};

/// Triangulation of a polygon with labelled segments.
struct LabelledTriangles {
    static constexpr std::uint8_t unlabelled = 255, border = 0;
    static constexpr std::uint32_t none = 0xffffffffu;
    std::vector<Vec2> points;
    std::vector<std::array<std::uint32_t, 3>> corners;    ///< Counter-clockwise.
    std::vector<std::array<std::uint8_t, 3>> labels;      ///< Label of the edge from corner i to the next.
    std::vector<std::array<std::uint32_t, 3>> neighbors;  ///< Index of the triangle across that edge, or none.
};

/// Like delaunay_triangles(), with additional segments that are kept as edges wherever they cross, touch, overlap or
/// leave the polygon. The border has the label `border`. Crossings are detected exactly; their positions are rounded.
/// Returns an empty result if CGAL fails or if the loops enclose nothing. Usually O((n + crossings) log n).
LabelledTriangles labelled_triangles(std::span<const std::vector<Vec2>> loops,
                                     std::span<const LabelledSegment> segments);

/// Delaunay refinement: adds points until no angle is below 20.7 degrees, except between two labelled edges and where a
/// new point would be too close to existing ones. A labelled edge is split if a circumcentre is beyond it or inside its
/// diametral circle. Source: [Ruppert95].
/// Returns at most about 20 triangles per triangle of `coarse`; returns `coarse` if CGAL fails.
LabelledTriangles refined_triangles(const LabelledTriangles& coarse);

}  // namespace exitance

#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Edges at which occluders end: the border edges of all regions, with the surfaces (sheets) that meet at each. An edge
/// shared by several regions appears once. Cuts inside a region are not edges. Construction: O(n log n).
class BlockerEdges {
  public:
    explicit BlockerEdges(const Occluders& occluders);

    struct Edge {
        Point a, b;
        std::uint32_t ends[2];  ///< Indices of the two corners. Edges that meet share a corner index.
        std::uint32_t first_sheet = 0, sheet_count = 0;
    };
    std::span<const Edge> edges() const { return edges_; }
    std::size_t corner_count() const { return corner_count_; }
    /// Indices into edges() of the border edges of region r.
    std::span<const std::uint32_t> of_region(RegionId r) const {
        return std::span(of_region_).subspan(first_[r.value], first_[r.value + 1] - first_[r.value]);
    }
    /// Returns whether at least one side of the edge, as seen from p, is not covered by a sheet at the edge. Otherwise
    /// sheets on both sides of the edge hide any visibility change there.
    bool is_outline(const Edge& edge, const Point& p) const;
    /// Returns which side of the edge, as seen from p, no sheet at the edge covers: 1 for the side that cross(a - p, b
    /// - p) points to, -1 for the other, 0 if both or neither are uncovered.
    int free_side(const Edge& edge, const Point& p) const;
    /// Distance within which corners coincide and points are in a plane, metres (1e-8 of the scene's size).
    double tolerance() const { return tolerance_; }

  private:
    std::pair<bool, bool> hidden_sides(const Edge& edge, const Point& p) const;
    void find_sheets(const Occluders& occluders);
    void add_sheets(const ConvexPiece& piece, std::span<const Point> corners, Edge& edge);

    std::vector<Edge> edges_;
    std::vector<Vec3> sheets_;  ///< Per sheet at an edge: the direction from the edge into the sheet.
    std::vector<std::uint32_t> of_region_, first_;
    std::size_t corner_count_ = 0;
    double tolerance_;
};

}  // namespace exitance

#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/visibility/occluders.hpp"

namespace exitance {

/// Where what blocks light ends: the border edges of all regions, those that several regions share only once, with the
/// sheets that meet there. Cuts within a region are no edges. O(n log n) to make.
class BlockerEdges {
  public:
    explicit BlockerEdges(const Occluders& occluders);

    struct Edge {
        Point a, b;
        std::uint32_t ends[2];  ///< Numbers of its corners: edges that meet have one in common.
        std::uint32_t first_sheet = 0, sheet_count = 0;
    };
    std::span<const Edge> edges() const { return edges_; }
    std::size_t corner_count() const { return corner_count_; }
    /// Edges on the border of a region.
    std::span<const std::uint32_t> of_region(RegionId r) const {
        return std::span(of_region_).subspan(first_[r.value], first_[r.value + 1] - first_[r.value]);
    }
    /// Seen from p, is there free sight on one side of the edge at least? Else what lies on both of its sides hides
    /// whatever happens there.
    bool is_outline(const Edge& edge, const Point& p) const;
    /// The side on which sight is free: 1 where cross(a - p, b - p) points to, -1 on the other, 0 where it is on both
    /// or on neither.
    int free_side(const Edge& edge, const Point& p) const;
    /// Do the corners lie within rounding of a piece's plane?
    double tolerance() const { return tolerance_; }

  private:
    std::pair<bool, bool> hidden_sides(const Edge& edge, const Point& p) const;
    void find_sheets(const Occluders& occluders);
    void add_sheets(const ConvexPiece& piece, std::span<const Point> corners, Edge& edge);

    std::vector<Edge> edges_;
    std::vector<Vec3> sheets_;  ///< Of each sheet at an edge: the direction into it, across the edge.
    std::vector<std::uint32_t> of_region_, first_;
    std::size_t corner_count_ = 0;
    double tolerance_;
};

}  // namespace exitance

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/bsp_tree.hpp"

namespace exitance {

/// Front-to-back orderings of a BSP tree from the corners of a source, and what they imply for all points of the
/// source.
///
/// Youngest common ancestor: let a segment from a point s of the source to a point of node N first meet a fragment of
/// node M. Let P be the plane of the youngest common ancestor of M and N. s is strictly on the side of P from which M
/// comes first. So is at least one corner of the source, and M precedes N in that corner's ordering. Hence the union,
/// over all corners, of the nodes that precede N contains everything that can hide any of the source from N: its
/// minimum candidate list. Source: [Gatenby95].
class SourceOrderings {
  public:
    /// `corners`: corners of the source's convex hull, at most 64 (more fail an EXI_CHECK: a subset of them would not
    /// contain the source). O(corners x nodes).
    SourceOrderings(const BspTree& tree, std::span<const Point> corners);

    std::size_t corner_count() const { return orders_.size(); }
    /// Nodes in front-to-back order as seen from a corner, including nodes whose plane contains the corner.
    std::span<const std::uint32_t> order(std::size_t corner) const { return orders_[corner]; }
    std::uint32_t place(std::size_t corner, std::uint32_t node) const { return places_[corner][node]; }

    /// Bit masks over corners. appears(): bit k is set if corner k sees the node's fragments from either side.
    /// sees_front(): bit k is set if corner k is in front of the node's plane.
    std::uint64_t appears(std::uint32_t node) const { return appears_[node]; }
    std::uint64_t sees_front(std::uint32_t node) const { return front_[node]; }

    /// Nodes that precede this one in some ordering, sorted by index. With `facing`, only nodes that turn a fragment's
    /// front to a corner in whose ordering they precede it; this suffices if bodies are closed.
    std::vector<std::uint32_t> candidates(std::uint32_t node, bool facing = false) const;
    /// Pieces of the candidate nodes, each once.
    std::vector<PieceId> candidate_pieces(std::uint32_t node, bool facing = false) const;

  private:
    bool turns_front_to(std::uint32_t node, std::size_t corner) const;

    const BspTree* tree_;
    std::vector<std::vector<std::uint32_t>> orders_, places_;  ///< Per corner.
    std::vector<std::uint64_t> appears_, front_;               ///< Per node.
};

/// Convex hull of coplanar points, counter-clockwise about the normal n. For a concave source these are the corners
/// that matter. Points on the hull's edges are left out.
std::vector<Point> convex_hull(std::span<const Point> points, const Normal& n);

}  // namespace exitance

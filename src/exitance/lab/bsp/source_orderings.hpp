#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/bsp_tree.hpp"

namespace exitance {

/// The front-to-back orderings of a BSP tree from the corners of a source, and what they tell of all its points.
///
/// Youngest common ancestor: let a segment from a point s of the source to a point of node N first meet a fragment of
/// node M. The plane of their youngest common ancestor has s strictly on the side from which M comes first; so it has
/// a corner of the source there, and M stands before N in that corner's ordering. Hence the union, over the corners,
/// of what stands before N holds all that can hide any of the source from N: its minimum candidate list.
/// Source: [Gatenby95].
class SourceOrderings {
  public:
    /// `corners`: of the source's convex hull, at most 64 of them (more: every k-th with its neighbours would not do,
    /// so that they are refused by EXI_CHECK). O(corners x nodes).
    SourceOrderings(const BspTree& tree, std::span<const Point> corners);

    std::size_t corner_count() const { return orders_.size(); }
    /// Nodes as a corner sees them, in front of others first; those in whose plane it lies, too.
    std::span<const std::uint32_t> order(std::size_t corner) const { return orders_[corner]; }
    std::uint32_t place(std::size_t corner, std::uint32_t node) const { return places_[corner][node]; }

    /// Bit k: does corner k see the node's fragments, from either side; does it see the front of the plane?
    std::uint64_t appears(std::uint32_t node) const { return appears_[node]; }
    std::uint64_t sees_front(std::uint32_t node) const { return front_[node]; }

    /// Nodes that stand before this one in some ordering, in rising order. Of `facing` alone: those that turn a
    /// fragment's front to a corner in whose ordering they do, enough where bodies are closed.
    std::vector<std::uint32_t> candidates(std::uint32_t node, bool facing = false) const;
    /// The pieces on these, each once.
    std::vector<PieceId> candidate_pieces(std::uint32_t node, bool facing = false) const;
    /// Bit k: does something that faces corner k stand before the node in its ordering? Where that holds for all
    /// corners that the node appears to, it may lie in umbra; where for none, nothing hides any of the source from it.
    std::uint64_t may_be_hidden(std::uint32_t node) const;

  private:
    bool turns_front_to(std::uint32_t node, std::size_t corner) const;

    const BspTree* tree_;
    std::vector<std::vector<std::uint32_t>> orders_, places_;  ///< By corner.
    std::vector<std::uint64_t> appears_, front_;               ///< By node.
};

/// The convex hull of points of a plane, counter-clockwise about its normal: of a concave source, the corners that
/// matter. Corners on the hull's edges are left out.
std::vector<Point> convex_hull(std::span<const Point> points, const Normal& n);

}  // namespace exitance

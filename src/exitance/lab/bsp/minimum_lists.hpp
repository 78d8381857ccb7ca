#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/bsp_tree.hpp"
#include "exitance/lab/bsp/source_orderings.hpp"

namespace exitance {

/// Minimum candidate lists of all regions of a scene for some sources. The fragments before a region's fragments in the
/// front-to-back ordering from any corner of a source (source_orderings.hpp) are the only ones that can hide any of the
/// source from the region. For several nodes, the union of what precedes them is what precedes the last of them, so a
/// list is stored as one position per ordering. Source: [Gatenby95]. Memory: O(corners x fragments) per source.
class MinimumLists {
  public:
    /// sources  points whose convex hull contains each source, metres. If a source has more than 64, a rectangle around
    /// them in their plane is used instead.
    /// normals  unit normals of the planes of these points
    MinimumLists(const Occluders& occluders, std::span<const std::vector<Point>> sources,
                 std::span<const Normal> normals);

    const BspTree& tree() const { return tree_; }
    std::size_t corner_count(std::size_t source) const { return orderings_[source].corner_count(); }
    /// True if the orderings are those from the given points, in the same order (false: from the corners of the
    /// rectangle).
    bool has_own_corners(std::size_t source) const { return has_own_corners_[source]; }

    /// A position in each ordering of a source: fragments before it may hide some of the source.
    using Limits = std::vector<std::uint32_t>;
    /// Limits of a whole region.
    Limits limits(std::size_t source, RegionId region) const;
    /// Limits of those fragments of a region that a convex part of it touches. `part`: metres, counter-clockwise about
    /// its normal n.
    Limits limits(std::size_t source, RegionId region, std::span<const Point> part, const Normal& n) const;

    /// Returns a bit mask; bit k is set if a fragment of the piece comes before the limit in the ordering from corner
    /// k.
    std::uint64_t stands_before(std::size_t source, PieceId piece, const Limits& limits) const;

    /// Pieces before the limit in the ordering from a corner, front to back, each once.
    std::vector<PieceId> in_order(std::size_t source, std::size_t corner, const Limits& limits) const;

  private:
    struct Place {
        std::uint32_t node = 0, fragment = 0;
    };
    std::span<const Place> places(PieceId p) const {
        return std::span(places_).subspan(first_place_[p.value], first_place_[p.value + 1] - first_place_[p.value]);
    }
    void find_places();

    const Occluders* occluders_;
    BspTree tree_;
    std::vector<SourceOrderings> orderings_;
    std::vector<bool> has_own_corners_;
    std::vector<Place> places_;  ///< Positions of the fragments of all pieces, piece after piece.
    std::vector<std::uint32_t> first_place_;
};

}  // namespace exitance

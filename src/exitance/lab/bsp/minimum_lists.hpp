#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/lab/bsp/bsp_tree.hpp"
#include "exitance/lab/bsp/source_orderings.hpp"

namespace exitance {

/// The minimum candidate lists of all regions of a scene for some sources: what stands before a region's fragments in
/// the front-to-back ordering from any corner of a source (source_orderings.hpp) is all that can hide any of the source
/// from it. The union of what stands before several nodes is what stands before the last of them, so that a list is one
/// place an ordering. Source: [Gatenby95]. O(corners x fragments) memory a source.
class MinimumLists {
  public:
    /// `sources`: points whose convex hull holds each source; of more than 64, a rectangle around them in their plane
    /// does it. `normals`: of the planes that they lie in.
    MinimumLists(const Occluders& occluders, std::span<const std::vector<Point>> sources,
                 std::span<const Normal> normals);

    const BspTree& tree() const { return tree_; }
    std::size_t corner_count(std::size_t source) const { return orderings_[source].corner_count(); }
    /// Are the orderings those from the points that were given, in their order?
    bool has_own_corners(std::size_t source) const { return has_own_corners_[source]; }

    /// A place in each ordering of a source: what comes before may hide some of it.
    using Limits = std::vector<std::uint32_t>;
    /// Of a region.
    Limits limits(std::size_t source, RegionId region) const;
    /// Of those of its fragments that a convex part of it meets, metres, counter-clockwise about its normal n.
    Limits limits(std::size_t source, RegionId region, std::span<const Point> part, const Normal& n) const;

    /// Bit k: does a fragment of the piece stand before the limit in the ordering from corner k?
    std::uint64_t stands_before(std::size_t source, PieceId piece, const Limits& limits) const;

    /// Pieces before the limit in the ordering from a corner, in front of others first, each once.
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
    std::vector<Place> places_;  ///< Of pieces, side by side.
    std::vector<std::uint32_t> first_place_;
};

}  // namespace exitance

#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/region_cover.hpp"

namespace exitance {

/// Visibility between the points of one convex polygon and the front of another.
enum class View : std::uint8_t {
    none,   ///< Certainly nothing is visible: one faces away, or one occluder blocks every segment between them.
    open,   ///< Certainly unoccluded above their horizons: no occluder reaches in between.
    mixed,  ///< Visibility is undecided; the candidates must be tested.
};

/// A convex polygon that emits or receives light at its front.
struct Facet {
    std::span<const Point> corners;  ///< Corners, counter-clockwise seen from the front, metres.
    Normal n;
    RegionId region;          ///< Region of the facet, which never occludes it; may be none.
    bool is_distant = false;  ///< Part of the sky: so far away that rounding errors matter.
};

/// Conservative tests of all segments between two convex polygons at once, using the convex hull of both (the shaft).
/// The supporting planes of the hull pass through an edge of one polygon and a corner of the other and have both on one
/// side. Source: [Haines91], with the polygons' own planes instead of boxes. A convex occluder blocks everything if it
/// meets all segments between corners: for fixed x, the points whose segment to x meets a convex set form a convex set.
/// A region with openings blocks everything if the convex hull of those segments' crossings misses the openings.
/// Results called certain hold except for slivers as thin as rounding. Polygons with a region must be on surfaces of
/// the scene.
class Shaft {
  public:
    /// Sets the pair of polygons. O(|R| |S| (|R| + |S|)). Can be reused without new allocations.
    void set(const Occluders& occluders, const Facet& receiver, const Facet& source);

    /// Classifies the pair against all occluders of the scene.
    /// candidates  receives, for a mixed view, all pieces that may be in between (cleared first)
    /// most  the search stops after finding more candidates than this; the view is then reported as mixed and the list
    /// is incomplete
    /// O(log n + most), plus boxes that the shaft meets although their pieces do not.
    View classify(std::vector<PieceId>& candidates, std::size_t most = all_candidates);
    static constexpr std::size_t all_candidates = std::numeric_limits<std::size_t>::max();

    /// Like the above, if only pieces in `from` can be in between: the candidates of a pair of polygons that contain
    /// these two. `candidates` must be a different vector.
    View classify(std::span<const PieceId> from, std::vector<PieceId>& candidates);

    /// Returns whether this piece, or its region, blocks every segment. classify() then reports View::none.
    bool is_blocked_by(PieceId p);
    /// The occluder that made classify() return View::none (valid only if an occluder was the reason).
    PieceId blocker() const { return blocker_; }

  private:
    void clip_by(const Plane& plane, std::vector<Point>& polygon);
    void add_supporting_planes(std::span<const Point> edges, std::span<const Point> corners);
    /// True if both polygons are on surfaces of the scene; pieces with all of the scene on one side are then not in
    /// between.
    bool are_in_scene() const { return !receiver_region_.is_none() && !source_region_.is_none(); }
    bool reaches_in(PieceId p);
    bool blocks_all(PieceId p);
    bool blocks_all(RegionId r);

    const Occluders* occluders_ = nullptr;
    RegionId receiver_region_, source_region_;
    PieceId blocker_;
    double slack_ = 0;                                      ///< Rounding tolerance, metres.
    std::vector<Point> receiver_, source_, buffer_, part_;  ///< The parts that face each other; scratch memory.
    Plane receiver_plane_, source_plane_;
    std::vector<Plane> planes_;
    RegionCover cover_;
    std::vector<RegionId> not_covering_;  ///< Regions of several pieces already found not to block everything.
    ConvexRegion region_;
};

}  // namespace exitance

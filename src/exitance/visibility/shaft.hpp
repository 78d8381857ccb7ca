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

/// What points of one convex polygon see of the front of another.
enum class View : std::uint8_t {
    none,   ///< Certainly nothing: turned away, or one occluder blocks every segment between them.
    open,   ///< Certainly everything that lies above their horizons: nothing reaches between them.
    mixed,  ///< Anything; the candidates tell.
};

/// A convex polygon that light leaves or reaches by its front.
struct Facet {
    std::span<const Point> corners;  ///< Counter-clockwise seen from the front, metres.
    Normal n;
    RegionId region;          ///< Its plane group, which never blocks; may be none.
    bool is_distant = false;  ///< Of the sky: so far away that rounding counts.
};

/// Certain answers about all segments between two convex polygons at once, from the convex hull of both (the shaft):
/// its supporting planes pass through an edge of one and a corner of the other and have both on one side.
/// Source: [Haines91] with the polygons' own planes in place of boxes; blocking by one convex occluder follows from the
/// segments between corners, since for fixed x the points whose segment to x meets a convex set form a convex set. A
/// region with openings blocks as the convex hull of those segments' crossings does, where that misses the openings.
/// "Certain" is up to slivers as thin as rounding. Polygons with a region lie on surfaces of the scene.
class Shaft {
  public:
    /// Prepares for a pair; O(|R| |S| (|R| + |S|)). Reusable, keeps its memory.
    void set(const Occluders& occluders, const Facet& receiver, const Facet& source);

    /// Classifies the pair, looking at every occluder of the scene. `candidates` receives, for a mixed view, all pieces
    /// that may stand in between (it is cleared first). The search ends where more than `most` of them are found: the
    /// view is mixed as far as is known then, and there may be others. O(log n + most) but for boxes that the shaft
    /// meets and their pieces do not.
    View classify(std::vector<PieceId>& candidates, std::size_t most = all_candidates);
    static constexpr std::size_t all_candidates = std::numeric_limits<std::size_t>::max();

    /// The same when only `from` can stand in between: the candidates of a pair of polygons that hold these.
    /// `candidates` must be another vector.
    View classify(std::span<const PieceId> from, std::vector<PieceId>& candidates);

    /// Does this piece, or its region, block every segment? If so, classify finds that, too.
    bool is_blocked_by(PieceId p);
    /// What blocked, after classify returned View::none because something did.
    PieceId blocker() const { return blocker_; }

  private:
    void clip_by(const Plane& plane, std::vector<Point>& polygon);
    void add_supporting_planes(std::span<const Point> edges, std::span<const Point> corners);
    /// Then what all of the scene lies on one side of does not stand between them.
    bool are_in_scene() const { return !receiver_region_.is_none() && !source_region_.is_none(); }
    bool reaches_in(PieceId p);
    bool blocks_all(PieceId p);
    bool blocks_all(RegionId r);

    const Occluders* occluders_ = nullptr;
    RegionId receiver_region_, source_region_;
    PieceId blocker_;
    double slack_ = 0;                                      ///< Metres that rounding may make.
    std::vector<Point> receiver_, source_, buffer_, part_;  ///< The parts that face each other; scratch.
    Plane receiver_plane_, source_plane_;
    std::vector<Plane> planes_;
    RegionCover cover_;
    std::vector<RegionId> in_vain_;  ///< Regions of several pieces that do not block everything.
    ConvexRegion region_;
};

}  // namespace exitance

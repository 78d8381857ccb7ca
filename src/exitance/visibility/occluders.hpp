#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/ids.hpp"
#include "exitance/scene/enclosure.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

using PieceId = Id<struct PieceTag>;  ///< One convex piece of a region.

/// A convex part of a region. It is the whole region if the border is one convex loop (however finely it was
/// subdivided); otherwise it is a convex part of one of its faces.
struct ConvexPiece {
    std::uint32_t first_corner = 0, corner_count = 0;
    RegionId region;
    SurfaceId surface;  ///< A face that contains it (the first face of the region if the piece is the whole region).
    Plane plane;
    double thickness = 0;  ///< Metres: points nearer to its plane than this are in the plane.
};

/// All occluders of a scene, as convex pieces in bounding volume hierarchies. Immutable; safe to share between threads.
class Occluders {
  public:
    explicit Occluders(const Scene& scene);

    const Scene& scene() const { return *scene_; }
    const Field<PieceId, ConvexPiece>& pieces() const { return pieces_; }
    /// Corners of a piece, counter-clockwise seen from its front, metres.
    std::span<const Point> corners(PieceId p) const {
        return std::span(corners_).subspan(pieces_[p].first_corner, pieces_[p].corner_count);
    }
    IdRange<PieceId> pieces(RegionId r) const { return of_region_[r]; }
    /// Facets of the sky (`distant_facets` of the scene). They block nothing and belong to no region. They are centred
    /// on the middle of the scene, at 1e6 times its size. To every point of the scene they appear as seen from
    /// middle().
    IdRange<PieceId> distant_pieces() const { return distant_; }
    bool is_distant(PieceId p) const { return pieces_[p].region.is_none(); }
    /// Panes through which the sky's light enters, for receivers inside the `enclosure`. They block nothing and belong
    /// to no region.
    IdRange<PieceId> windows() const { return windows_; }
    bool is_window(PieceId p) const { return !windows_.empty() && p.value >= windows_.front().value; }
    const Enclosure& enclosure() const { return enclosure_; }
    /// Viewpoint to subtract from the corners of a distant piece, instead of the receiver's position.
    const Point& middle() const { return middle_; }
    /// Distance by which a region's pieces are raised off its plane because the region is on top of others in that
    /// plane (Region::level), metres.
    double lift(RegionId r) const;

    /// The pieces are in two trees: the 4 sqrt(n) largest by area (walls, floors, ceilings), and all others. Usually a
    /// large piece is the occluder, and it is found quickly.
    enum class Size : std::uint8_t { large, small };

    /// Calls visit(piece) for every piece of a size class whose box is not entirely outside one plane of the region,
    /// roughly in order along `direction`, until visit returns true. Returns whether it did.
    template <class Visit>
    bool visit_region(Size size, const ConvexRegion& region, const Visit& visit, const Vec3& direction) const {
        return (size == Size::large && walk(outer_, region, visit, direction)) ||
               visit_inner(size, region, visit, direction);
    }

    /// Calls visit(piece) for every piece of a size class whose box meets the segment from `origin` to origin + d,
    /// nearer ones first, until visit returns true. For large pieces, those with all of the scene on one side come
    /// first.
    template <class Visit>
    void visit_segment(Size size, const Point& origin, const Vec3& d, const Visit& visit) const {
        bool ended = false;
        const auto walk_along = [&](const Tree& tree) {
            tree.bvh.visit_segment(origin, d, 1, [&](std::uint32_t i) {
                ended = visit(tree.pieces[i]);
                return ended ? 0.0 : 1.0;
            });
        };
        if (size == Size::large) walk_along(outer_);
        if (!ended) walk_along(trees_[static_cast<std::size_t>(size)]);
    }

    /// Returns whether a region is the receiver's own, or the other side of the same sheet. Neither can shade the
    /// receiver.
    bool is_own(RegionId region, RegionId own) const {
        return region == own || (other_side_.size() > 0 && !own.is_none() && other_side_[own] == region);
    }

    /// Like visit_region, without pieces that have all of the scene on one side, such as the walls of a single room:
    /// they block no segment between surfaces.
    template <class Visit>
    bool visit_inner(Size size, const ConvexRegion& region, const Visit& visit, const Vec3& direction) const {
        return walk(trees_[static_cast<std::size_t>(size)], region, visit, direction);
    }
    /// Returns whether all pieces have all of the scene on one side, so that nothing blocks anything.
    bool has_nothing_inside() const { return outer_.pieces.size() == pieces_.size(); }

    /// True if a receiver at x, with the normal n, and a piece lie in one plane (ConvexPiece::thickness), such as the
    /// two sides of a sheet. Neither sees the other, although rounding in files may put either before the other.
    bool lie_in_one_plane(const Point& x, const Normal& n, PieceId p) const;
    /// Distance within which two points count as equal, metres: a few roundings of the coordinates.
    double rounding() const { return rounding_; }

    /// Returns whether another surface covers the point x of region `own`, so that no light can reach it. The other
    /// side of a sheet or of a thin wall does not cover it. A surface that faces the same way covers x only if
    /// it is above x by more than rounding; of two surfaces in the same plane neither covers the other.
    bool is_covered(const Point& x, const Normal& n, RegionId own) const;

    /// Sets the walls without thickness (`find_thin_walls`); none are known before.
    void set_thin_walls(std::vector<std::pair<RegionId, RegionId>> sorted) { thin_walls_ = std::move(sorted); }

    std::size_t memory_bytes() const;
    /// Calls visit(span) for the arrays that hold most of the memory.
    template <class Visit>
    void visit_arrays(const Visit& visit) const {
        visit(pieces_.span()), visit(of_region_.span()), visit(std::span(corners_)), visit(other_side_.span());
        for (const Tree* tree : {&trees_[0], &trees_[1], &outer_})
            visit(std::span(tree->pieces)), tree->bvh.visit_arrays(visit);
    }

  private:
    void make_trees();
    void add_distant_pieces();
    void add_windows();
    std::vector<std::uint8_t> find_outer() const;
    void add_piece(std::span<const Point> corners, RegionId region, SurfaceId surface, const Plane& plane);
    bool is_back_of(RegionId a, RegionId b) const;
    bool is_thin_wall(RegionId a, RegionId b) const {
        return !thin_walls_.empty() &&
               std::binary_search(thin_walls_.begin(), thin_walls_.end(), std::pair(std::min(a, b), std::max(a, b)));
    }

    const Scene* scene_;
    Field<PieceId, ConvexPiece> pieces_;
    Field<RegionId, IdRange<PieceId>> of_region_;
    std::vector<Point> corners_;
    std::vector<std::pair<RegionId, RegionId>> thin_walls_;  ///< Sorted; the smaller id first.
    Field<RegionId, RegionId> other_side_;  ///< Other side of each sheet; empty if no region is a side of a sheet.
    struct Tree {
        std::vector<PieceId> pieces;
        Bvh bvh;
    };
    template <class Visit>
    static bool walk(const Tree& tree, const ConvexRegion& region, const Visit& visit, const Vec3& direction) {
        return tree.bvh.visit_region(
            region, [&](std::uint32_t i) { return visit(tree.pieces[i]); }, direction);
    }

    std::array<Tree, 2> trees_;  ///< Indexed by Size; without the pieces of `outer_`.
    Tree outer_;                 ///< Pieces with all of the scene on one side.
    IdRange<PieceId> distant_, windows_;
    Enclosure enclosure_;
    Point middle_;
    double rounding_ = 0;
};

}  // namespace exitance

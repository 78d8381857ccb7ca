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

/// A convex part of a region: the whole region where its border is one convex loop (however finely it was cut), else
/// a convex part of one of its faces.
struct ConvexPiece {
    std::uint32_t first_corner = 0, corner_count = 0;
    RegionId region;
    SurfaceId surface;  ///< A face it lies on (the region's first one where the piece is the whole region).
    Plane plane;
    double thickness = 0;  ///< Metres; what lies nearer to its plane than this lies in it.
};

/// Everything that blocks light, as convex pieces with a tree of boxes over them. Immutable, shared by all threads.
class Occluders {
  public:
    explicit Occluders(const Scene& scene);

    const Scene& scene() const { return *scene_; }
    const Field<PieceId, ConvexPiece>& pieces() const { return pieces_; }
    /// Counter-clockwise seen from the front, metres.
    std::span<const Point> corners(PieceId p) const {
        return std::span(corners_).subspan(pieces_[p].first_corner, pieces_[p].corner_count);
    }
    IdRange<PieceId> pieces(RegionId r) const { return of_region_[r]; }
    /// Faces of the sky, which block nothing and are no part of any region: `distant_facets` of the scene, about its
    /// middle, a million times as far away as it is large. Every point of the scene counts as their middle
    /// (`middle`).
    IdRange<PieceId> distant_pieces() const { return distant_; }
    bool is_distant(PieceId p) const { return pieces_[p].region.is_none(); }
    /// Panes, which block nothing and are no part of any region either: the sky's light comes from them where the
    /// `enclosure` holds the receiver.
    IdRange<PieceId> windows() const { return windows_; }
    bool is_window(PieceId p) const { return !windows_.empty() && p.value >= windows_.front().value; }
    const Enclosure& enclosure() const { return enclosure_; }
    /// What is to be taken from a corner of a distant piece in place of the point that it is seen from.
    const Point& middle() const { return middle_; }
    /// How far a region's pieces stand off its plane because they lie on others in it (Region::level), metres.
    double lift(RegionId r) const;

    /// The pieces in two trees: the largest few (4 sqrt(n) by area: walls, floors, ceilings) and the others. What is
    /// hidden at all is hidden by a large one as a rule, and these are found at once.
    enum class Size : std::uint8_t { large, small };

    /// Calls visit(piece) for every piece of a size whose box is not wholly outside one plane of the region, roughly
    /// along `direction`, until visit returns true. Returns whether it did.
    template <class Visit>
    bool visit_region(Size size, const ConvexRegion& region, const Visit& visit, const Vec3& direction) const {
        return (size == Size::large && walk(outer_, region, visit, direction)) ||
               visit_inner(size, region, visit, direction);
    }

    /// Calls visit(piece) for every piece of a size whose box the segment from `origin` to origin + d meets, nearer
    /// ones first (those that all of the scene lies on one side of before the other large ones), until visit returns
    /// true.
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

    /// Is a region the one that a receiver lies on, or the other side of the same sheet? Neither can shade it.
    bool is_own(RegionId region, RegionId own) const {
        return region == own || (other_side_.size() > 0 && !own.is_none() && other_side_[own] == region);
    }

    /// As visit_region, without the pieces that all of the scene lies on one side of, such as the walls of a single
    /// room: they stand between no two points of surfaces.
    template <class Visit>
    bool visit_inner(Size size, const ConvexRegion& region, const Visit& visit, const Vec3& direction) const {
        return walk(trees_[static_cast<std::size_t>(size)], region, visit, direction);
    }
    /// Is there no piece but those?
    bool has_nothing_inside() const { return outer_.pieces.size() == pieces_.size(); }

    /// How far apart two places may be that are meant to be the same, metres: a few roundings of the coordinates.
    double rounding() const { return rounding_; }

    /// Does another surface lie on the point x of region `own`, front to front, so that no light can get there? A sheet
    /// whose other side is a region of the same outline does not lie on itself. A surface on top of it with its front
    /// upwards counts when it is above by more than rounding; of two that share a plane neither covers the other.
    bool is_covered(const Point& x, const Normal& n, RegionId own) const;

    std::size_t memory_bytes() const;
    /// Calls visit(span) for the plain arrays that most of it stands in.
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

    const Scene* scene_;
    Field<PieceId, ConvexPiece> pieces_;
    Field<RegionId, IdRange<PieceId>> of_region_;
    std::vector<Point> corners_;
    Field<RegionId, RegionId> other_side_;  ///< Empty where no region is one side of a sheet.
    struct Tree {
        std::vector<PieceId> pieces;
        Bvh bvh;
    };
    template <class Visit>
    static bool walk(const Tree& tree, const ConvexRegion& region, const Visit& visit, const Vec3& direction) {
        return tree.bvh.visit_region(
            region, [&](std::uint32_t i) { return visit(tree.pieces[i]); }, direction);
    }

    std::array<Tree, 2> trees_;  ///< Indexed by Size; without the outer ones.
    Tree outer_;                 ///< Pieces with all of the scene on one side.
    IdRange<PieceId> distant_, windows_;
    Enclosure enclosure_;
    Point middle_;
    double rounding_ = 0;
};

}  // namespace exitance

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/visibility/lit_part.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// A place that light arrives at: its surface's plane group neither shades it nor counts as in its way.
struct Receiver {
    Point x;       ///< Metres.
    Normal n;      ///< Of length 1.
    RegionId own;  ///< The region it lies on, or none (free space).
};

/// Scratch memory of the functions below: one a thread, used again and again, so that no query allocates.
class VisibilityWorkspace {
  public:
    /// Convex polygons in one array of corners, grown and cut without freeing. Corners are relative to the receiver.
    struct Polygons {
        std::vector<Vec3> corners;
        std::vector<std::uint32_t> ends;  ///< Polygon i holds corners [ends[i-1], ends[i]).

        void clear() { corners.clear(), ends.clear(); }
        void close() { ends.push_back(static_cast<std::uint32_t>(corners.size())); }
        std::size_t size() const { return ends.size(); }
        std::span<const Vec3> operator[](std::size_t i) const {
            const std::size_t first = i == 0 ? 0 : ends[i - 1];
            return std::span(corners).subspan(first, ends[i] - first);
        }
    };
    /// An occluder's pyramid: the unit normals (pointing inwards) of the planes through the receiver and its edges.
    struct Shadow {
        std::uint32_t first_plane = 0, plane_count = 0;
        double solid_angle = 0;     ///< Roughly; orders the occluders.
        std::uint32_t outline = 0;  ///< Its polygon among the outlines,
        bool reversed = false;      ///< which runs clockwise as seen from the receiver.
    };

    std::vector<Vec3> source, source_pyramid, clipped, side;
    std::vector<Vec3> planes;
    std::vector<Shadow> shadows;
    Polygons outlines;
    LitPart lit;
    std::vector<Rectangle> boxes;
    std::vector<std::pair<double, double>> intervals;
    std::vector<PieceId> candidates;
    std::vector<double> heights;
    std::vector<double> factors;  ///< Of sources that are all visible.
    ConvexRegion region;
    RegionCover cover;
    std::vector<RegionId> uncovering;  ///< Regions of several pieces that do not hide all of the source.
    Shaft shaft;

    /// What hid a source last, and is likely to hide it again: asked first, it saves the search. What it does not hide
    /// is searched for as ever, so the answer does not depend on it; nor does it when the workspace comes from another
    /// scene, since only pieces that there are are remembered.
    PieceId& last_blocker(const Occluders& occluders, PieceId source) {
        Blocker& entry = blockers_[source.value % blockers_.size()];
        const bool known = entry.source == source && entry.blocker.value < occluders.pieces().size();
        if (!known) entry = {source, PieceId()};
        return entry.blocker;
    }

  private:
    struct Blocker {
        PieceId source, blocker;
    };
    std::array<Blocker, 1024> blockers_;
};

/// How the visible part is found: by cutting the source, or by its boundary (edge_sum.hpp). Both are exact, and test
/// each other; cutting is faster (10 occluders in view 10 and 12 microseconds, 72 of them 104 and 162).
enum class VisiblePartMethod : std::uint8_t { subtraction, edge_sums };

/// How light leaves the source, and how its visible part is found.
struct PartLight {
    PartLight(VisiblePartMethod m = VisiblePartMethod::subtraction) : method(m) {}
    PartLight(const RelativeRadiance& r) : radiance(r) {}
    VisiblePartMethod method = VisiblePartMethod::subtraction;
    RelativeRadiance radiance;  ///< Where it is directed, form factors are weighted by it; parts are subtracted then.
};

/// Form factor from a receiver to the visible part of one convex piece of a source: exact but for rounding, occluders
/// taken from the tree. What lies in the plane of the source or on the receiver's own region never blocks; everything
/// else blocks from both sides. 0 behind the source.
///
/// The source is cut by the planes through x and the occluders' edges; what falls inside an occluder's pyramid goes.
/// Source: [Nishita85], as polygon subtraction. O(f k) for k occluders in the pyramid over the source and f fragments.
double visible_form_factor(const Occluders& occluders, const Receiver& at, PieceId source, VisibilityWorkspace& scratch,
                           const PartLight& light = {});

/// The same with occluders given by the caller: all pieces that may reach into the pyramid, in any order, harmless ones
/// included. Pieces of the receiver's and of the source's own region may be among them.
double visible_form_factor(const Occluders& occluders, const Receiver& at, PieceId source,
                           std::span<const PieceId> candidates, VisibilityWorkspace& scratch,
                           const PartLight& light = {});

}  // namespace exitance

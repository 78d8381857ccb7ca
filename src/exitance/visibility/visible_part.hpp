#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/scene/surface_point.hpp"
#include "exitance/visibility/lit_part.hpp"
#include "exitance/visibility/occluders.hpp"
#include "exitance/visibility/shaft.hpp"

namespace exitance {

/// Scratch memory of the functions below. Use one object per thread and reuse it, so that queries do not allocate.
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
    /// The pyramid over an occluder: unit normals (pointing inwards) of the planes through the receiver and its edges.
    struct Shadow {
        std::uint32_t first_plane = 0, plane_count = 0;
        double solid_angle = 0;     ///< Approximate solid angle, used for sorting the occluders.
        std::uint32_t outline = 0;  ///< Index of its polygon in `outlines`.
        bool reversed = false;      ///< True if that polygon is clockwise as seen from the receiver.
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
    std::vector<double> factors;  ///< Form factors of fully visible sources.
    ConvexRegion region;
    RegionCover cover;
    std::vector<RegionId> uncovering;  ///< Regions of several pieces already found not to hide the whole source.
    Shaft shaft;

    /// Work done by visible_form_factor() so far, in units of about 0.2 us (a possible blocker, a fragment that is
    /// cut). Above `max_work` it gives up and returns any value; the work depends on its arguments alone.
    double work = 0, max_work = HUGE_VAL;
    bool gave_up() const { return work > max_work; }
    /// Work of the integral of a directed radiance over a fragment. Measured by `bench/exitance-bench`.
    static constexpr double work_of_integral = 20;

    /// The last piece that hid a source completely. It is tested first because it will probably hide the source again.
    /// If it does not, the usual search follows, so the result does not depend on it. A workspace may be reused with
    /// another scene, because indices that are out of range are discarded.
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

/// Method for the visible part: clipping the source (subtraction), or summing over its boundary (edge_sum.hpp). Both
/// are exact and are tested against each other. Clipping is faster: 10 us against 12 us with 10 occluders in view, 104
/// us against 162 us with 72.
enum class VisiblePartMethod : std::uint8_t { subtraction, edge_sums };

/// Directional distribution of the source, and the method for its visible part.
struct PartLight {
    PartLight(VisiblePartMethod m = VisiblePartMethod::subtraction) : method(m) {}
    PartLight(const RelativeRadiance& r) : radiance(r) {}
    VisiblePartMethod method = VisiblePartMethod::subtraction;
    /// Relative radiance of the source. If directed, it weights form factors and `subtraction` is used.
    RelativeRadiance radiance;
};

/// Form factor from a receiver to the visible part of one convex piece of a source, exact except for rounding.
/// Occluders are searched in the tree. Pieces in the plane of the source and the receiver's own region never block;
/// everything else blocks from both sides. Returns 0 behind the source.
///
/// The source is clipped by the planes through x and the occluders' edges, and the parts inside an occluder's pyramid
/// are removed. Source: [Nishita85], as polygon subtraction. O(f k) for k occluders in the pyramid over the source and
/// f fragments.
double visible_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                           VisibilityWorkspace& scratch, const PartLight& light = {});

/// Like the above, with given occluders: all pieces that may reach into the pyramid, in any order. Other pieces,
/// including those of the receiver's and the source's own regions, do no harm.
double visible_form_factor(const Occluders& occluders, const SurfacePoint& at, PieceId source,
                           std::span<const PieceId> candidates, VisibilityWorkspace& scratch,
                           const PartLight& light = {});

}  // namespace exitance

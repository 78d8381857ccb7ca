#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/form_factors/point_to_polygon_batch.hpp"
#include "exitance/visibility/convex_blockers.hpp"
#include "exitance/visibility/critical_lines.hpp"

namespace exitance {

/// Visible share of a source. If one blocker hides all of it (`nothing`), this holds until one of the blocker's
/// critical lines is crossed. If several blockers do so together (`nothing_past_several`), parts may appear at a
/// three-edge event.
enum class Seen : std::uint8_t { nothing, nothing_past_several, part, all };

/// Form factor from points to the visible part of one convex source behind given blockers, exact except for rounding.
/// The parts inside a blocker's pyramid are clipped away by the planes through the point and the blocker's silhouette
/// edges; Lambert's contour sum gives the form factor of the rest. All computation is in the source's plane, where
/// blockers are projected and most are separated from a fragment by bounding boxes. Source: [Nishita85]. One object per
/// thread; can be reused for many pairs.
class VisibleSource {
  public:
    /// Sets a source and the blockers that may be in between. Every blocker must be entirely in front of the source's
    /// plane, and the source entirely in front of the planes of the points passed later. Keeps references.
    void set(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers);

    /// Returns the form factor from x (normal n) to the visible part, and sets `seen`. O(blockers + fragments): about
    /// 0.1 us for one body in between.
    double operator()(const Point& x, const Normal& n, Seen& seen);

    /// Form factor without occluders.
    double unoccluded(const Point& x, const Normal& n);

  private:
    /// A convex part of the source, in coordinates of its plane with the origin at the foot of the current point.
    struct Polygon {
        static constexpr std::size_t lanes = 4;
        /// Corners of a fragment that is cut: one of more is split first.
        static constexpr std::size_t max_fragment = 24;
        /// Lines of a blocker's silhouette: a sheet with more edges is split; solids have at most 32 faces.
        static constexpr std::size_t max_lines = 32;
        /// Capacity: every line adds at most one corner. The rest is a margin for solids with many silhouette edges.
        static constexpr std::size_t most = max_fragment + max_lines + 8;
        std::size_t count;
        double u[most + lanes], v[most + lanes];
        double low_u, high_u, low_v, high_v;
        void clear() { count = 0, low_u = low_v = HUGE_VAL, high_u = high_v = -HUGE_VAL; }
        void add(double x, double y) {
            if (count == most) return;
            u[count] = x, v[count++] = y;
            low_u = std::min(low_u, x), high_u = std::max(high_u, x);
            low_v = std::min(low_v, y), high_v = std::max(high_v, y);
        }
        void close() {  // whole groups of lanes are read
            for (std::size_t i = 0; i + 1 < lanes && count > 0; ++i)
                u[count + i] = u[count - 1], v[count + i] = v[count - 1];
        }
        void copy(const Polygon& other);  ///< Copies only the used entries.
    };
    /// A blocker in the coordinates of the source.
    struct Body {
        const ConvexBlocker* shape;
        std::uint32_t first_point, first_face;
    };
    /// Intersection of a plane through the point with the source's plane: a u + b v + c > none inside the pyramid.
    struct Line {
        double a, b, c, none;
    };
    struct Pyramid {
        std::uint32_t first, last;  ///< Range in `lines_`.
        std::uint32_t likely;       ///< The line that separated the last fragment; tested first.
        double low_u, high_u, low_v, high_v;
        double overlap;                           ///< Overlap of the shadow's bounding box with the source's, m^2.
        bool is_beside(const Polygon& p) const {  ///< Tests the bounding boxes.
            return (low_u >= p.high_u) | (high_u <= p.low_u) | (low_v >= p.high_v) | (high_v <= p.low_v);
        }
    };

    Vec3 turned(const Vec3& d) const { return {dot(frame_.u, d), dot(frame_.v, d), dot(frame_.n, d)}; }
    void look_from(const Point& x);
    bool find_box(const Body& body, Pyramid& pyramid) const;
    bool add_pyramid(const Body& body, Pyramid& pyramid, bool& inside);
    struct Sides {
        bool any_in, any_out;
    };
    Sides measure(const Polygon& polygon, const Line& line, double* heights) const;
    bool misses(const Polygon& fragment, Pyramid& pyramid) const;
    void find_cuts(const Polygon& fragment, const Pyramid& pyramid);
    void split_sheet(const ConvexBlocker& sheet);
    void subtract(const Polygon& fragment, std::size_t first, std::size_t last, bool is_whole);
    void subtract_halves(const Polygon& fragment, std::size_t first, std::size_t last);
    void clip_source(const Pyramid& pyramid, Polygon& inside, bool& is_whole) const;
    bool find_shadows();
    bool take_shadows();
    void put_largest_first();
    void add_edges(const Polygon& polygon, double weight);
    static void cut(const Polygon& polygon, const double* heights, double sign, Polygon& out);

    std::span<const Point> source_;
    PlaneFrame frame_{{}, {0, 0, 1}};  ///< Frame of the source.
    std::vector<Vec2> corners_;        ///< Corners of the source, in that frame.
    std::vector<Body> bodies_;
    /// Corners of the bodies: two coordinates in the source's plane, and the height over it.
    std::vector<Vec3> points_;
    std::vector<Plane> faces_;
    double size_ = 0;
    Vec3 x_;    ///< The point from which the source is seen.
    Normal n_;  ///< Normal of the receiver at x_.
    Polygon whole_;
    std::vector<Line> lines_;
    std::vector<Pyramid> pyramids_;
    std::vector<std::uint32_t> reaching_;  ///< A stack of pyramids that may hide some of the current fragments.
    std::vector<std::uint8_t> in_front_;
    std::vector<ConvexBlocker> split_;  ///< Parts of sheets with more edges than max_lines.
    std::vector<Polygon> pool_;         ///< Storage for fragments, used as a stack.
    std::size_t pool_used_ = 0;
    std::vector<Polygon> shadows_;     ///< Shadows on the source, one per pyramid.
    std::vector<std::uint32_t> cuts_;  ///< Lines that cross the fragments on the stack.
    double weight_ = 1;                ///< Weight of the remaining fragments in the sum.
    bool anything_lit_ = false, anything_hidden_ = false, hidden_by_one_ = false;
    EdgeTerms terms_;
};

}  // namespace exitance

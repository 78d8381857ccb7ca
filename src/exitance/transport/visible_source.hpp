#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/transport/convex_blockers.hpp"
#include "exitance/transport/form_factor_batch.hpp"

namespace exitance {

/// How much of a source a point sees. What one blocker hides alone stays hidden until one of its critical lines is
/// crossed; what several hide together may show at an event of three edges.
enum class Seen : std::uint8_t { nothing, nothing_past_several, part, all };

/// The form factor from points to the visible part of one convex source behind given blockers, exact but for rounding.
/// What lies in a blocker's pyramid is cut away by the planes through the point and the edges of the blocker's
/// silhouette; Lambert's contour sum does the rest. Source: [Nishita85]. One object serves one thread and many pairs.
class VisibleSource {
  public:
    /// Takes a source and the blockers that may stand in its light. All of every blocker must lie in front of the
    /// source's plane, and all of the source in front of the plane of the points to come. Keeps references.
    void set(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers);

    /// Form factor from x (normal n) to the visible part, and how much that is. O(blockers + fragments): about 0.1 us
    /// for one body in the way.
    double operator()(const Point& x, const Normal& n, Seen& seen);

    /// The same as if nothing stood in the way.
    double unoccluded(const Point& x, const Normal& n);

    /// Does one blocker alone hide all of the source from all of a convex receiver? Certain when true: segments between
    /// the corners of both decide for all segments.
    bool is_hidden_from(std::span<const Point> receiver);

  private:
    struct Polygon {
        static constexpr std::size_t most = 24;
        std::size_t count;
        double xyz[most][3];
        Vec3 at(std::size_t i) const { return {xyz[i][0], xyz[i][1], xyz[i][2]}; }
        void add(const Vec3& p) {
            if (count < most) xyz[count][0] = p.x, xyz[count][1] = p.y, xyz[count][2] = p.z, ++count;
        }
        void copy(const Polygon& other) {  // no more than is used
            count = other.count;
            std::copy_n(&other.xyz[0][0], 3 * count, &xyz[0][0]);
        }
    };
    struct Pyramid {
        std::uint32_t first, last;  ///< Its planes.
        std::uint32_t likely;       ///< The plane that had the last fragment outside.
    };

    bool add_pyramid(const ConvexBlocker& blocker, const Point& x, bool& inside);
    struct Sides {
        bool any_in, any_out;
    };
    Sides measure(const Polygon& polygon, const Vec3& plane, double* heights) const;
    bool misses(const Polygon& fragment, Pyramid& pyramid) const;
    bool find_cuts(const Polygon& fragment, const Pyramid& pyramid);
    void subtract(const Polygon& fragment, std::size_t first, std::size_t last, bool is_whole);
    void add_edges(const Polygon& polygon, double weight);
    static void cut(const Polygon& polygon, const double* heights, double sign, Polygon& out);

    std::span<const Point> source_;
    std::span<const ConvexBlocker* const> blockers_;
    double size_ = 0;
    Normal n_;
    std::vector<Vec3> planes_;
    std::vector<Pyramid> pyramids_;
    std::vector<std::uint32_t> reaching_;  ///< A stack: pyramids that may hide some of the fragments at hand.
    std::vector<std::uint8_t> in_front_;
    std::vector<Polygon> pool_;  ///< A stack of fragments.
    std::size_t pool_used_ = 0;
    std::vector<std::uint32_t> cuts_;  ///< Planes that run through the fragments on the stack.
    bool anything_lit_ = false, anything_hidden_ = false, hidden_by_one_ = false;
    EdgeTerms terms_;
};

}  // namespace exitance

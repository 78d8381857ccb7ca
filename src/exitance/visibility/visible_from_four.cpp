#include "exitance/visibility/visible_from_four.hpp"

#include <cmath>
#include <memory>

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"

namespace exitance {
namespace {

using namespace four;

constexpr std::size_t max_corners = 20, max_planes = 160, max_fragments = 160;

/// A convex polygon relative to each of the four points.
struct Polygon {
    std::size_t count;
    Vec corner[max_corners];
};

EXITANCE_INLINE Vec spread(const Vec3& p) {
    return {Real{} + p.x, Real{} + p.y, Real{} + p.z};
}
EXITANCE_INLINE Real absolute(const Real& v) {
    return max(v, -v);
}

/// Lambert's contour sum over a polygon, without its factor 1 / (2 pi).
EXITANCE_INLINE void sum_edges(const Polygon& polygon, const Normal& n, Real& sum) {
    sum = Real{};
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const Vec &a = polygon.corner[i], &b = polygon.corner[i + 1 == polygon.count ? 0 : i + 1];
        const Vec c = cross(a, b - a);
        const Real sine = max(sqrt(dot(c, c)), Real{} + min_length_of_product);
        sum -= angle_over_sine(sine, dot(a, b)) * dot(n, c);
    }
}

}  // namespace

/// The subtraction of VisibleSource, step by step. Every decision must be the same for all four points.
class VisibleFromFour::Work {
  public:
    bool run(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers,
             const std::array<Point, 4>& x, const Normal& n, std::array<double, 4>& out, Seen& seen) {
        if (source.size() > 12) return false;
        alike_ = true, lit_ = hidden_ = hidden_by_one_ = false;
        n_ = n;
        plane_count_ = pyramid_count_ = fragments_ = 0;
        total_ = Real{};
        x_ = {Real{x[0].x, x[1].x, x[2].x, x[3].x}, Real{x[0].y, x[1].y, x[2].y, x[3].y},
              Real{x[0].z, x[1].z, x[2].z, x[3].z}};
        Polygon& whole = pool_[fragments_++];
        whole.count = 0;
        size_ = Real{};
        towards_ = spread(-area_vector(source));
        for (const Point& p : source) {
            const Vec r = spread(p) - x_;
            size_ = max(size_, absolute(r.x) + absolute(r.y) + absolute(r.z));
            whole.corner[whole.count++] = r;
        }
        for (const ConvexBlocker* blocker : blockers) {
            bool inside = false;
            if (!add_pyramid(*blocker, inside)) return false;
            if (inside) {
                out.fill(0);
                seen = Seen::nothing;
                return true;
            }
        }
        subtract(whole, 0, true);
        if (!alike_) return false;
        seen = !lit_ ? (hidden_by_one_ ? Seen::nothing : Seen::nothing_past_several) : hidden_ ? Seen::part : Seen::all;
        const Real F = max(total_ * (1 / (2 * pi)), Real{});
        for (std::size_t i = 0; i < 4; ++i) out[i] = lit_ ? F[i] : 0;
        return true;
    }

  private:
    struct Pyramid {
        std::size_t first, last;
    };

    /// Adds the planes of a blocker's silhouette. If an edge is on the silhouette from only some of the points, the
    /// other points get a plane that cuts nothing off the source. Returns false if only some of the points are inside
    /// the blocker, or if the array of planes is full.
    bool add_pyramid(const ConvexBlocker& blocker, bool& inside) {
        std::array<int, ConvexBlocker::max_faces + 1> in_front;
        int any_front = 0;
        for (std::size_t k = 0; k < blocker.faces.size(); ++k) {
            in_front[k] = bits(dot(blocker.faces[k].n, x_) - blocker.faces[k].offset > 0);
            any_front |= in_front[k];
        }
        inside = blocker.is_solid() && any_front == 0;
        if (inside) return true;
        if (blocker.is_solid() && any_front != 15) return false;
        if (plane_count_ + blocker.edges.size() > max_planes || pyramid_count_ == pyramids_.size()) return false;
        const std::size_t first = plane_count_;
        for (const ConvexBlocker::Edge& e : blocker.edges) {
            const int left = in_front[static_cast<std::size_t>(e.left)];
            const int outline =
                e.right == ConvexBlocker::no_face ? 15 : left ^ in_front[static_cast<std::size_t>(e.right)];
            if (outline == 0) continue;
            const Vec a = spread(blocker.points[e.a]) - x_, b = spread(blocker.points[e.b]) - x_;
            Vec plane = cross(b, a);
            if ((left & outline) != outline) {  // some of the points see the blocker's face from behind
                const Real side = {left & 1 ? 1. : -1., left & 2 ? 1. : -1., left & 4 ? 1. : -1., left & 8 ? 1. : -1.};
                plane = {side * plane.x, side * plane.y, side * plane.z};
            }
            if (outline != 15)
                for (int lane = 0; lane < 4; ++lane)
                    if ((outline >> lane & 1) == 0)
                        plane.x[lane] = towards_.x[lane], plane.y[lane] = towards_.y[lane],
                        plane.z[lane] = towards_.z[lane];
            planes_[plane_count_++] = plane;
        }
        if (plane_count_ - first >= 3)
            pyramids_[pyramid_count_++] = {first, plane_count_};
        else
            plane_count_ = first;
        return true;
    }

    /// Position of a polygon relative to a plane. `inside` has a bit for each point for which some of the polygon is
    /// inside.
    struct Standing {
        int inside = 0;
        bool any_out = false, alike = true;
    };

    /// Computes the heights of the corners over a plane, and their signs (-1, 0 or 1) per corner.
    Standing measure(const Polygon& polygon, const Vec& plane, Real* heights, int* signs) const {
        const Real none = zero_sine * size_ * (absolute(plane.x) + absolute(plane.y) + absolute(plane.z));
        Standing standing;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            heights[i] = dot(plane, polygon.corner[i]);
            const int above = bits(heights[i] > none), below = bits(heights[i] < -none);
            standing.alike &= (above == 0 || above == 15) && (below == 0 || below == 15);
            signs[i] = (above != 0) - (below != 0);
            standing.inside |= above, standing.any_out |= below != 0;
        }
        return standing;
    }

    /// Returns whether the fragment is outside a pyramid for all points, possibly beyond a different side for each. If
    /// not, `cuts` receives the planes that cross it.
    bool is_beside(const Polygon& fragment, const Pyramid& pyramid, std::array<std::size_t, 40>& cuts,
                   std::size_t& count) {
        Real heights[max_corners];
        int signs[max_corners], beside = 0;
        bool alike = true;
        count = 0;
        for (std::size_t k = pyramid.first; k < pyramid.last; ++k) {
            const Standing standing = measure(fragment, planes_[k], heights, signs);
            beside |= 15 & ~standing.inside;
            if (beside == 15) return true;
            alike &= standing.alike;
            if (!standing.any_out) continue;
            if (count == cuts.size()) return alike_ = false;
            cuts[count++] = k;
        }
        alike_ &= alike && beside == 0;
        return false;
    }

    /// Computes the part of a polygon with sign * height >= 0. Returns false if it has too many corners.
    static bool cut(const Polygon& polygon, const Real* heights, const int* signs, int sign, Polygon& out) {
        out.count = 0;
        for (std::size_t i = 0; i < polygon.count; ++i) {
            const std::size_t j = i + 1 == polygon.count ? 0 : i + 1;
            if (out.count + 2 > max_corners) return false;
            if (sign * signs[i] >= 0) out.corner[out.count++] = polygon.corner[i];
            if (signs[i] * signs[j] < 0) {
                const Real t = heights[i] / (heights[i] - heights[j]);
                const Vec &p = polygon.corner[i], e = polygon.corner[j] - p;
                out.corner[out.count++] = {p.x + t * e.x, p.y + t * e.y, p.z + t * e.z};
            }
        }
        return true;
    }

    void add_edges(const Polygon& polygon, double weight) {
        Real sum;
        call_for_four([&]() EXITANCE_INLINE_LAMBDA { sum_edges(polygon, n_, sum); });
        total_ += weight * sum;
    }

    void subtract(const Polygon& fragment, std::size_t next, bool is_whole) {
        std::array<std::size_t, 40> cuts;
        std::size_t cut_count = 0;
        while (next < pyramid_count_ && is_beside(fragment, pyramids_[next], cuts, cut_count)) ++next;
        if (!alike_) return;
        if (next == pyramid_count_) {
            lit_ = true;
            add_edges(fragment, 1);
            return;
        }
        if (cut_count == 0) {
            hidden_ = true;
            hidden_by_one_ |= is_whole;
            return;
        }
        const std::size_t mark = fragments_;
        if (fragments_ + cut_count + 2 > max_fragments) {
            alike_ = false;
            return;
        }
        const bool last = next + 1 == pyramid_count_;
        std::size_t rest = fragments_++, spare = fragments_++;
        const std::size_t first_offcut = fragments_;
        const Polygon* polygon = &fragment;
        bool beside = false;
        for (std::size_t c = 0; alike_ && !beside && c < cut_count; ++c) {
            Real heights[max_corners];
            int signs[max_corners];
            const Standing standing = measure(*polygon, planes_[cuts[c]], heights, signs);
            beside = standing.inside == 0;
            alike_ &= standing.alike;
            if (beside || !standing.any_out) continue;
            if (!last) alike_ &= cut(*polygon, heights, signs, -1, pool_[fragments_++]);
            alike_ &= cut(*polygon, heights, signs, 1, pool_[spare]);
            std::swap(rest, spare);
            polygon = &pool_[rest];
        }
        if (alike_ && beside) {
            fragments_ = mark;
            subtract(fragment, next + 1, is_whole);
        } else if (alike_ && last) {
            hidden_ = lit_ = true;
            add_edges(fragment, 1);
            add_edges(*polygon, -1);
        } else if (alike_) {
            hidden_ = true;
            const std::size_t end = fragments_;
            for (std::size_t i = first_offcut; alike_ && i < end; ++i) subtract(pool_[i], next + 1, false);
        }
        fragments_ = mark;
    }

    Vec x_, towards_;
    Normal n_;
    Real size_, total_;
    bool alike_, lit_, hidden_, hidden_by_one_;
    std::size_t plane_count_ = 0, pyramid_count_ = 0, fragments_ = 0;
    std::array<Vec, max_planes> planes_;
    std::array<Pyramid, 64> pyramids_;
    std::array<Polygon, max_fragments> pool_;
};

VisibleFromFour::VisibleFromFour() : work_(new Work) {}
VisibleFromFour::~VisibleFromFour() {
    delete work_;
}

bool VisibleFromFour::operator()(std::span<const Point> source, std::span<const ConvexBlocker* const> blockers,
                                 const std::array<Point, 4>& x, const Normal& n, std::array<double, 4>& out,
                                 Seen& seen) {
    return work_->run(source, blockers, x, n, out, seen);
}

}  // namespace exitance

#include "exitance/mesh/gap_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/base/error_share.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

/// Ends of the strips, in heights of the gap. At the last one, 1% of the light at the mouth is left.
constexpr std::array<double, 3> strip_ends{1, 3, 7};

/// Minimum ratio of width to height for a gap with strips: the first strip and an equal distance to the middle, from
/// both sides.
constexpr double min_width_ratio = 4;

/// An edge of a border along which a gap may open, with unit vectors in the plane along it and into the region.
struct Mouth {
    Point p, q;
    Vec3 along, inwards;

    Mouth(const Point& from, const Point& to, const Normal& n)
        : p(from), q(to), along(normalized(to - from)), inwards(cross(n, along)) {}
};

/// Extent of a region from a mouth inwards, metres.
double width_at(const Mouth& mouth, const Region& region) {
    double inwards = 0;
    for (const std::vector<Point>& loop : region.loops)
        for (const Point& corner : loop) inwards = std::max(inwards, dot(mouth.inwards, corner - mouth.p));
    return inwards;
}

/// Positions along a mouth at which the opposite surface is searched: the middles of its thirds.
constexpr double middle = 0.5;
constexpr std::array<double, 3> positions_along{1.0 / 6, middle, 5.0 / 6};  // derived from the thirds
/// Minimum cosine of the angle between the two sides of a gap. Chosen: half of it gives the same light, measured by
/// `exitance solve gaps.obj --error 0.02`. Without gaps, its true error is 26% larger.
constexpr double min_cosine = 0.9;

/// A region opposite a mouth, its largest distance (metres), and whether it is opposite the mouth's middle.
struct Opposite {
    RegionId region;
    double height;
    bool is_in_the_middle;
};

/// Finds the gaps at the border of one region.
class GapFinder {
  public:
    /// `is_minor`: true to search the opposite side at the middles of the border's edges only.
    GapFinder(const Scene& scene, const Bvh& faces, double touching, RegionId own, bool is_minor)
        : scene_(scene),
          faces_(faces),
          touching_(touching),
          own_(own),
          is_minor_(is_minor),
          plane_(scene.regions()[own].plane) {
        Box box;
        for (const std::vector<Point>& loop : region(own).loops)
            for (const Point& corner : loop) box.add(corner);
        highest_ = norm(box.hi - box.lo) / min_width_ratio;
    }

    std::vector<GapLine> run() {
        for (const std::vector<Point>& loop : region(own_).loops)
            for (std::size_t i = 0; i < loop.size(); ++i) find_at({loop[i], loop[(i + 1) % loop.size()], plane_.n});
        return std::move(out_);
    }

  private:
    const Region& region(RegionId r) const { return scene_.regions()[r]; }

    void find_at(const Mouth& mouth) {
        opposite_.clear();
        for (const double along : positions_along)
            if (!is_minor_ || along == middle) look_from(mouth, along);
        if (opposite_.empty()) return;
        const double own_width = width_at(mouth, region(own_));
        for (const Opposite& other : opposite_) {
            const double width = std::min(own_width, width_at(mouth, region(other.region)));
            add_strips(mouth, other.region, other.height, width);
            if (other.is_in_the_middle) add_strips(mouth, own_, other.height, width);
        }
    }

    /// Records the nearest surface in front of a point at the mouth, if it faces back.
    void look_from(const Mouth& mouth, double along) {
        const Point x = mouth.p + along * (mouth.q - mouth.p) + touching_ * mouth.inwards;
        Opposite nearest{RegionId(), highest_, along == middle};
        bool looks_back = false;
        Box box;
        box.add(x + touching_ * plane_.n), box.add(x + highest_ * plane_.n);
        faces_.visit_box(box, [&](std::uint32_t i) {
            const SurfaceId s(i);
            const RegionId r = scene_.surfaces()[s].region;
            const Plane& other = region(r).plane;
            const double down = -dot(other.n, plane_.n);
            if (r == own_ || down == 0) return;
            const double h = other.signed_distance(x) / down;
            if (h <= touching_ || h > nearest.height) return;
            if (!contains(scene_.outline(s), other.n, x + h * plane_.n)) return;
            nearest.region = r, nearest.height = h, looks_back = down > min_cosine;
        });
        if (!looks_back) return;
        for (Opposite& known : opposite_)
            if (known.region == nearest.region) {
                known.height = std::max(known.height, nearest.height);
                known.is_in_the_middle |= nearest.is_in_the_middle;
                return;
            }
        opposite_.push_back(nearest);
    }

    void add_strips(const Mouth& mouth, RegionId on, double height, double width) {
        const std::size_t first = out_.size();
        const Plane& plane = region(on).plane;
        const auto foot = [&](const Point& x) { return x - plane.signed_distance(x) * plane.n; };
        double depth = 0;
        for (const double end : strip_ends) {
            const double at = end * height, strip = at - depth;
            if (0.5 * width - at < strip) break;
            depth = at;
            const Vec3 across = at * mouth.inwards;
            out_.push_back({foot(mouth.p + across), foot(mouth.q + across), height, 0, at, mouth.inwards, on});
        }
        for (std::size_t i = first; i < out_.size(); ++i) out_[i].depth = depth;
    }

    const Scene& scene_;
    const Bvh& faces_;
    double touching_, highest_ = 0;
    RegionId own_;
    bool is_minor_;
    const Plane& plane_;
    std::vector<Opposite> opposite_;  ///< Faces opposite the current mouth of a gap.
    std::vector<GapLine> out_;
};

}  // namespace

std::vector<GapLine> find_gap_lines(const Scene& scene, const Bvh& faces, double touching) {
    double area = 0;
    for (const Region& region : scene.regions()) area += region.area;
    const std::size_t count = scene.regions().size();
    const double small = count > ErrorShare::max_even_count ? ErrorShare::small_area(area, count) : 0;
    std::vector<std::vector<GapLine>> found(count);
    parallel_for(count, 64, [&](std::size_t r) {
        const bool is_minor = scene.regions()[RegionId(r)].area < small;
        found[r] = GapFinder(scene, faces, touching, RegionId(r), is_minor).run();
    });
    std::vector<GapLine> out;
    for (const std::vector<GapLine>& lines : found) out.insert(out.end(), lines.begin(), lines.end());
    return out;
}

}  // namespace exitance

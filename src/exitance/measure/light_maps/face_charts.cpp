#include "exitance/measure/light_maps/face_charts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "exitance/base/limits.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/measure/light_maps/common_corners.hpp"
#include "exitance/measure/light_maps/uv_layout.hpp"

namespace exitance {
namespace {

/// Largest angle between a face and the axis of its chart: derived from areas, which shrink to 0.77 at most.
constexpr double max_chart_angle = 40 * pi / 180;

/// Neighbours of each region, across edges of faces.
class RegionNeighbours {
  public:
    explicit RegionNeighbours(const Scene& scene) {
        using End = std::tuple<double, double, double>;
        struct Edge {
            std::pair<End, End> ends;
            RegionId region;
        };
        std::vector<Edge> edges;
        const CommonCorners corners(scene);
        const auto end_of = [&](const Point& p) {
            const Point& at = corners.at(p);
            return End{at.x, at.y, at.z};
        };
        for (const SurfaceId s : scene.surfaces().ids()) {
            const std::span<const Point> outline = scene.outline(s);
            for (std::size_t i = 0; i < outline.size(); ++i)
                edges.push_back({std::minmax(end_of(outline[i]), end_of(outline[(i + 1) % outline.size()])),
                                 scene.surfaces()[s].region});
        }
        std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
        std::vector<std::pair<RegionId, RegionId>> pairs;
        for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
            while (last < edges.size() && edges[last].ends == edges[first].ends) ++last;
            for (std::size_t i = first; i < last; ++i)
                for (std::size_t k = first; k < last; ++k)
                    if (edges[i].region != edges[k].region && can_join(scene, edges[i].region, edges[k].region))
                        pairs.emplace_back(edges[i].region, edges[k].region);
        }
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        of_.resize(scene.regions().size());
        for (const auto& [a, b] : pairs) of_[a].push_back(b);
    }

    const std::vector<RegionId>& of(RegionId r) const { return of_[r]; }

  private:
    static std::uint32_t group(const Scene& scene, RegionId r) {
        return scene.surfaces()[scene.regions()[r].surfaces.front()].group.value;
    }
    static bool can_join(const Scene& scene, RegionId a, RegionId b) {
        const Region &p = scene.regions()[a], &q = scene.regions()[b];
        return p.material == q.material && group(scene, a) == group(scene, b) &&
               dot(p.plane.n, q.plane.n) > std::cos(max_chart_angle);
    }

    Field<RegionId, std::vector<RegionId>> of_;
};

class ChartGrower {
  public:
    explicit ChartGrower(const Scene& scene) : scene_(scene), neighbours_(scene), state_(scene.regions().size()) {
        for (const RegionId r : scene.regions().ids()) order_.push_back(r);
        std::stable_sort(order_.begin(), order_.end(),
                         [&](RegionId a, RegionId b) { return scene.regions()[a].area > scene.regions()[b].area; });
    }

    /// Grows charts until no region is left.
    void grow_all(std::vector<FaceChart>& out) {
        for (const RegionId seed : order_)
            if (state_[seed] == State::left) out.push_back(grow_from(seed));
    }
    /// Takes the regions from number `first` on out of a chart, so that they are left for other charts.
    void release(FaceChart& chart, std::size_t first) {
        for (std::size_t i = first; i < chart.regions.size(); ++i) state_[chart.regions[i]] = State::left;
        chart.regions.resize(first);
    }

  private:
    enum class State : std::uint8_t { left, in_chart, taken };

    /// Makes the chart around a seed: first with the seed's normal as axis, then twice with the mean of the normals.
    FaceChart grow_from(RegionId seed) {
        constexpr int rounds = 3;
        FaceChart chart{{}, scene_.regions()[seed].plane.n};
        for (int round = 0; round < rounds; ++round) {
            Vec3 sum;
            for (const RegionId r : chart.regions) {
                sum += scene_.regions()[r].area * scene_.regions()[r].plane.n;
                state_[r] = State::left;
            }
            if (round > 0 && is_near(seed, normalized(sum))) chart.axis = normalized(sum);
            collect(seed, chart);
        }
        for (const RegionId r : chart.regions) state_[r] = State::taken;
        return chart;
    }

    bool is_near(RegionId r, const Normal& axis) const {
        return dot(scene_.regions()[r].plane.n, axis) > std::cos(max_chart_angle);
    }

    /// Collects the regions around a seed, nearest ones first.
    void collect(RegionId seed, FaceChart& chart) {
        chart.regions.assign(1, seed);
        state_[seed] = State::in_chart;
        for (std::size_t i = 0; i < chart.regions.size(); ++i)
            for (const RegionId r : neighbours_.of(chart.regions[i])) {
                if (state_[r] != State::left || !is_near(r, chart.axis)) continue;
                state_[r] = State::in_chart;
                chart.regions.push_back(r);
            }
    }

    const Scene& scene_;
    RegionNeighbours neighbours_;
    Field<RegionId, State> state_;
    std::vector<RegionId> order_;
};

/// Marks charts whose projections overlap themselves: each is laid out as an object in a square of its own.
std::vector<std::uint8_t> find_overlapping(const Scene& scene, std::span<const FaceChart> charts,
                                           std::span<const std::size_t> which) {
    UvSet set;
    const int across = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(which.size())))));
    for (std::uint32_t c = 0; c < which.size(); ++c) {
        const FaceChart& chart = charts[which[c]];
        const Frame frame(chart.axis);
        set.objects.emplace_back();
        const std::size_t first = set.triangles.size();
        Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
        for (const RegionId r : chart.regions)
            for (const SurfaceId s : scene.regions()[r].surfaces) {
                const std::span<const Point> outline = scene.outline(s);
                for (const auto& [i, j, k] : triangulate(outline, scene.surfaces()[s].normal)) {
                    UvTriangle t{s, c, {outline[i], outline[j], outline[k]}, {}};
                    for (std::size_t n = 0; n < 3; ++n) {
                        const Vec2 p{dot(frame.u, t.corner[n]), dot(frame.v, t.corner[n])};
                        t.place[n] = p;
                        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)},
                        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
                    }
                    set.triangles.push_back(t);
                }
            }
        const double size = std::max({hi.x - lo.x, hi.y - lo.y, min_divisor}) * across;
        const Vec2 square{1.0 * (static_cast<int>(c) % across) / across, 1.0 * (static_cast<int>(c) / across) / across};
        for (std::size_t t = first; t < set.triangles.size(); ++t)
            for (Vec2& p : set.triangles[t].place) p = square + (1 / size) * (p - lo);
    }
    std::vector<std::uint8_t> out;
    for (const UvObject& object : lay_out(set).objects) out.push_back(object.overlapping > 0);
    return out;
}

/// Corners of the convex hull, counter-clockwise. O(n log n).
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Vec2> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t first = hull.size();
        for (const Vec2& p : points) {
            while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
                hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

}  // namespace

std::vector<FaceChart> find_face_charts(const Scene& scene) {
    ChartGrower grower(scene);
    std::vector<FaceChart> charts;
    grower.grow_all(charts);
    std::vector<std::size_t> fresh(charts.size());
    std::iota(fresh.begin(), fresh.end(), std::size_t(0));
    while (!fresh.empty()) {
        std::erase_if(fresh, [&](std::size_t c) { return charts[c].regions.size() == 1; });
        const std::vector<std::uint8_t> overlaps = find_overlapping(scene, charts, fresh);
        std::vector<std::size_t> next;
        for (std::size_t i = 0; i < fresh.size(); ++i)
            if (overlaps[i]) {
                grower.release(charts[fresh[i]], (charts[fresh[i]].regions.size() + 1) / 2);
                next.push_back(fresh[i]);
            }
        const std::size_t first = charts.size();
        grower.grow_all(charts);
        for (std::size_t c = first; c < charts.size(); ++c) next.push_back(c);
        fresh = std::move(next);
    }
    return charts;
}

ChartFrame smallest_frame(const Scene& scene, const FaceChart& chart) {
    const Frame frame(chart.axis);
    std::vector<Vec2> points;
    for (const RegionId r : chart.regions)
        for (const std::vector<Point>& loop : scene.regions()[r].loops)
            for (const Point& p : loop) points.push_back({dot(frame.u, p), dot(frame.v, p)});
    const std::vector<Vec2> hull = convex_hull(std::move(points));
    double smallest = HUGE_VAL;
    Vec2 right{1, 0};
    // Rectangles of equal area must not be chosen by rounding; derived from the precision of coordinates.
    constexpr double rounding = 1e-9;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 edge = hull[(i + 1) % hull.size()] - hull[i];
        const double length = std::hypot(edge.x, edge.y);
        if (!(length > 0)) continue;
        const Vec2 u = (1 / length) * edge, v{-u.y, u.x};
        double width_lo = HUGE_VAL, width_hi = -HUGE_VAL, height_lo = HUGE_VAL, height_hi = -HUGE_VAL;
        for (const Vec2& p : hull) {
            width_lo = std::min(width_lo, dot(u, p)), width_hi = std::max(width_hi, dot(u, p));
            height_lo = std::min(height_lo, dot(v, p)), height_hi = std::max(height_hi, dot(v, p));
        }
        const double width = width_hi - width_lo, height = height_hi - height_lo;
        if (width * height >= smallest * (1 - rounding)) continue;
        smallest = width * height;
        right = width >= height ? u : v;  // wider than high, as the packing prefers
    }
    const Vec3 across = right.x * frame.u + right.y * frame.v;
    return {across, cross(chart.axis, across)};
}

}  // namespace exitance

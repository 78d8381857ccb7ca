#include "exitance/scene/bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <string_view>
#include <tuple>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/base/morton.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

/// Joins faces that share both end points of an edge, in either direction.
void join_by_edges(const Scene& scene, DisjointSets& sets) {
    std::vector<Point> corners;
    for (SurfaceId s : scene.surfaces().ids())
        corners.insert(corners.end(), scene.outline(s).begin(), scene.outline(s).end());
    // Derived from the tolerance of planes, 1e-5: joining nearly coplanar faces moves the corners of each by up to
    // that.
    constexpr double moved = 2e-5;
    const std::vector<std::uint32_t> place = weld(corners, moved * scene.size());
    struct Edge {
        std::uint32_t low, high, face;
        auto operator<=>(const Edge&) const = default;
    };
    std::vector<Edge> edges;
    edges.reserve(corners.size());
    std::uint32_t first = 0;
    for (SurfaceId s : scene.surfaces().ids()) {
        const auto n = static_cast<std::uint32_t>(scene.outline(s).size());
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t from = place[first + k], to = place[first + (k + 1) % n];
            edges.push_back({std::min(from, to), std::max(from, to), s.value});
        }
        first += n;
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high)
            sets.unite(edges[i].face, edges[i - 1].face);
}

/// The group name that readers give to faces without an object in the file.
constexpr std::string_view no_object = "default";

/// Joins the faces of every named object, and those of every region.
void join_by_name(const Scene& scene, DisjointSets& sets) {
    Field<GroupId, SurfaceId> first(scene.groups().size(), SurfaceId());
    for (SurfaceId s : scene.surfaces().ids()) {
        const GroupId group = scene.surfaces()[s].group;
        if (group.is_none() || scene.groups()[group].empty() || scene.groups()[group] == no_object) continue;
        if (first[group].is_none())
            first[group] = s;
        else
            sets.unite(first[group].value, s.value);
    }
    for (const Region& region : scene.regions())
        for (SurfaceId s : region.surfaces) sets.unite(region.surfaces[0].value, s.value);
}

/// Collects the faces of every set, sorted by first face.
SceneBodies bodies_of(const Scene& scene, DisjointSets& sets) {
    SceneBodies out;
    out.body.resize(scene.surfaces().size(), 0);
    for (SurfaceId s : scene.surfaces().ids()) {
        const std::uint32_t root = sets.root(s.value);  // the smallest member is the root and comes first
        if (root == s.value) {
            out.body[s] = static_cast<std::uint32_t>(out.all.size());
            out.all.push_back({.first = s});
        }
        SceneBody& body = out.all[out.body[s] = out.body[SurfaceId(root)]];
        const double area = scene.surfaces()[s].area;
        ++body.surfaces, body.area += area;
        body.centre += area * centroid(scene.outline(s));
    }
    for (SceneBody& body : out.all) body.centre = body.centre / body.area;
    return out;
}

/// The two opposite directions that most of a body's area faces.
class Sides {
  public:
    /// Adds a face: its normal, times its area in m^2, and its centroid, metres.
    void add(const Vec3& normal, double area, const Point& at) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) tensor_[i][k] += area * normal[i] * normal[k];
        area_ += area, flux_ += area * dot(normal, at), sum_ += area * normal, centre_ += area * at;
    }
    /// Finds the main direction by power iteration.
    void settle() {
        std::size_t largest = 0;
        for (std::size_t i = 1; i < 3; ++i)
            if (tensor_[i][i] > tensor_[largest][largest]) largest = i;
        Vec3 v{};
        v[largest] = 1;
        constexpr int iterations = 60;  // each iteration at least halves the other directions, given by `min_share`
        for (int i = 0; i < iterations; ++i) v = normalized(times(v));
        axis_ = v;
    }
    /// True if the body is a sheet, a plate or a row of parallel ones: at least two thirds of its area face one of two
    /// opposite directions, and these two sides face away from each other.
    bool is_flat(double size) const {
        constexpr double min_share = 2.0 / 3, rounding = 1e-9;
        const double outwards = flux_ - dot(sum_, centre_ / area_);  // three times the volume of a closed body
        return dot(axis_, times(axis_)) >= min_share * area_ && outwards >= -rounding * area_ * size;
    }
    /// Returns 1 or -1 for a face of one of the sides, and 0 for the rim: faces more than 60 degrees off.
    int of(const Normal& normal) const {
        const double cosine = dot(axis_, normal);
        return cosine >= 0.5 ? 1 : cosine <= -0.5 ? -1 : 0;
    }

  private:
    Vec3 times(const Vec3& v) const { return {dot(tensor_[0], v), dot(tensor_[1], v), dot(tensor_[2], v)}; }

    Vec3 tensor_[3];  ///< Sum of area n n^T, m^2.
    double area_ = 0, flux_ = 0;
    Vec3 sum_, centre_, axis_;
};

/// Separates the two sides of flat bodies. The rim belongs to the larger side; of equal ones, to that of the first
/// face.
DisjointSets separate_sides(const Scene& scene, const SceneBodies& joined) {
    std::vector<Sides> sides(joined.all.size());
    for (SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        sides[joined.body[s]].add(surface.normal, surface.area, centroid(scene.outline(s)));
    }
    for (Sides& body : sides) body.settle();
    std::vector<double> more(joined.all.size(), 0);  // area of the side along the axis minus that of the other, m^2
    std::vector<int> first_side(joined.all.size(), 0);
    for (SurfaceId s : scene.surfaces().ids()) {
        const std::uint32_t b = joined.body[s];
        const int side = sides[b].of(scene.surfaces()[s].normal);
        more[b] += side * scene.surfaces()[s].area;
        if (first_side[b] == 0) first_side[b] = side;
    }
    DisjointSets out(scene.surfaces().size());
    std::vector<std::array<SurfaceId, 2>> first(joined.all.size(), {SurfaceId(), SurfaceId()});
    for (SurfaceId s : scene.surfaces().ids()) {
        constexpr double rounding = 1e-9;  // relative difference of areas that count as equal
        const std::uint32_t b = joined.body[s];
        int side = 1;
        if (sides[b].is_flat(scene.size())) {
            side = sides[b].of(scene.surfaces()[s].normal);
            if (side == 0)
                side = std::abs(more[b]) <= rounding * joined.all[b].area ? first_side[b] : more[b] > 0 ? 1 : -1;
        }
        SurfaceId& start = first[b][side > 0 ? 0 : 1];
        if (start.is_none()) start = s;
        out.unite(start.value, s.value);
    }
    return out;
}

/// Bodies in the order of a Morton curve, as a linked list from which the smallest are removed.
class Pool {
  public:
    Pool(const Scene& scene, const SceneBodies& bodies) : area_(bodies.all.size()) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
        for (std::uint32_t b = 0; b < area_.size(); ++b) {
            area_[b] = bodies.all[b].area, centre_.push_back(bodies.all[b].centre);
            order.emplace_back(morton(bodies.all[b].centre, scene.box()), b);
        }
        std::sort(order.begin(), order.end());
        before_.assign(area_.size(), none), after_.assign(area_.size(), none);
        for (std::size_t i = 1; i < order.size(); ++i)
            before_[order[i].second] = order[i - 1].second, after_[order[i - 1].second] = order[i].second;
    }

    /// Merges the smallest body with the nearer of its two neighbours until `count` are left; calls join(a, b) for
    /// each.
    template <class Join>
    void shrink(std::size_t count, const Join& join) {
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> smallest;
        for (std::uint32_t b = 0; b < area_.size(); ++b) smallest.emplace(area_[b], b);
        for (std::size_t left = area_.size(); left > count;) {
            const auto [area, b] = smallest.top();
            smallest.pop();
            if (area != area_[b]) continue;  // outdated entry: the body has grown or was merged
            const std::uint32_t into = neighbour(b);
            join(b, into);
            const double share = area / (area_[into] + area);
            centre_[into] = (1 - share) * centre_[into] + share * centre_[b];
            area_[into] += area, area_[b] = -1;
            if (before_[b] != none) after_[before_[b]] = after_[b];
            if (after_[b] != none) before_[after_[b]] = before_[b];
            smallest.emplace(area_[into], into);
            --left;
        }
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;

    std::uint32_t neighbour(std::uint32_t b) const {
        const std::uint32_t x = before_[b], y = after_[b];
        if (x == none || y == none) return x == none ? y : x;
        return squared_norm(centre_[x] - centre_[b]) <= squared_norm(centre_[y] - centre_[b]) ? x : y;
    }

    std::vector<double> area_;  ///< m^2; negative for a body that was merged into another.
    std::vector<Point> centre_;
    std::vector<std::uint32_t> before_, after_;
};

}  // namespace

SceneBodies find_bodies(const Scene& scene, std::size_t max_bodies) {
    DisjointSets sets(scene.surfaces().size());
    join_by_edges(scene, sets);
    join_by_name(scene, sets);
    sets = separate_sides(scene, bodies_of(scene, sets));
    SceneBodies out = bodies_of(scene, sets);
    if (out.all.size() <= std::max<std::size_t>(1, max_bodies)) return out;
    Pool(scene, out).shrink(std::max<std::size_t>(1, max_bodies), [&](std::uint32_t a, std::uint32_t b) {
        sets.unite(out.all[a].first.value, out.all[b].first.value);
    });
    return bodies_of(scene, sets);
}

}  // namespace exitance

#include "exitance/scene/bodies.hpp"

#include <algorithm>
#include <queue>
#include <string_view>
#include <tuple>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/scene/joining/weld.hpp"

namespace exitance {
namespace {

/// Joins faces that share both end points of an edge, in either direction.
void join_by_edges(const Scene& scene, DisjointSets& sets) {
    std::vector<Point> corners;
    for (SurfaceId s : scene.surfaces().ids())
        corners.insert(corners.end(), scene.outline(s).begin(), scene.outline(s).end());
    // Uses the tolerance of the findings about edges.
    const std::vector<std::uint32_t> place = weld(corners, 1e-8 * scene.size());
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
        const std::uint32_t root = sets.root(s.value);  // the smallest member, which comes first
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

/// Returns the position of a point on a Morton curve through a box, 20 bits per axis.
std::uint64_t morton(const Point& p, const Box& box) {
    std::uint64_t out = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = box.hi[axis] - box.lo[axis];
        const double at = extent > 0 ? std::clamp((p[axis] - box.lo[axis]) / extent, 0.0, 1.0) : 0;
        const auto cell = static_cast<std::uint64_t>(at * 0xfffff);
        for (unsigned bit = 0; bit < 20; ++bit) out |= (cell >> bit & 1) << (3 * bit + axis);
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
    SceneBodies out = bodies_of(scene, sets);
    if (out.all.size() <= std::max<std::size_t>(1, max_bodies)) return out;
    Pool(scene, out).shrink(std::max<std::size_t>(1, max_bodies), [&](std::uint32_t a, std::uint32_t b) {
        sets.unite(out.all[a].first.value, out.all[b].first.value);
    });
    return bodies_of(scene, sets);
}

}  // namespace exitance

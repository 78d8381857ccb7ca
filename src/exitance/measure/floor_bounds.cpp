#include "exitance/measure/floor_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

constexpr double max_step = 0.3;      ///< Metres; derived from steps of stairs, at most 0.25 m high.
constexpr double step_share = 0.15;   ///< Share of the height, derived from such steps in rooms of 2 m.
constexpr double nearly_all = 0.9;    ///< Share of the outline; derived from pipes and posts at machines.
constexpr double solid_share = 0.25;  ///< Share of the outline, derived from racks between three walls.
constexpr double large_share = 0.25;  ///< Share of the lower room's area, derived from split levels.
constexpr double small_share = 0.05;  ///< Share of the lower room's area, derived from loading docks.
constexpr double wide = 3;            ///< Metres; derived from containers, 2.5 m wide, and presses.
constexpr double wide_share = 1.5;    ///< Share of the rise, derived from containers in models out of scale.
/// Least height of the space above a floor, as a share of the floor's height above the ground. The space above the
/// highest roof of a model without ceilings has no height of its own. Derived from storeys: a tenth of ten of them.
constexpr double least_height_share = 0.1;
constexpr double standing_height = 1.9;     ///< Metres; derived from the height of people.
constexpr double standing_share = 0.6;      ///< Share of the rise, derived from racks of two shelves.
constexpr std::size_t max_edges = 2000;     ///< Derived from a tenth of a second of ray casting.
constexpr std::size_t max_places = 20000;   ///< Derived from 200 m^2 of stairs and landings.
constexpr std::size_t sampled_cells = 100;  ///< Derived from the share of half of the cells, to 5% (one sigma).
constexpr double apart = 2e-3;  ///< Metres; two faces that are closer are one sheet: derived from `one_plane`.

const Vec3 down{0, 0, -1};

/// Height of a floor above the lowest point of the scene, metres.
double height_above_ground(const Scene& scene, const FloorCells& storey) {
    return storey.floor().shapes[0].loops[0][0].z - scene.box().lo.z;
}

/// Examines one part of a floor.
class Bounds {
  public:
    Bounds(const Scene& scene, const RayTracer& tracer, const FloorCells& storey, std::uint32_t part,
           const FindLowerRoom& find_lower_room)
        : scene_(scene),
          tracer_(tracer),
          storey_(storey),
          part_(part),
          height_(std::max(storey.parts()[part].height, least_height_share * height_above_ground(scene, storey))),
          step_(std::min(max_step, step_share * height_)) {
        std::vector<FloorCells::Edge> edges = storey.edges(part);
        const std::size_t stride = (edges.size() + max_edges - 1) / max_edges;
        for (std::size_t i = 0; i < edges.size(); i += stride) edges_.push_back(edges[i]);
        depth_.resize(edges_.size()), kind_.resize(edges_.size());
        parallel_for(edges_.size(), 16, [&](std::size_t i) { kind_[i] = kind_of(i); });
        // On one thread: the results are combined, and there are few edges.
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (kind_[i] != Kind::falls) continue;
            const std::optional<LowerRoom> room = find_lower_room(edges_[i].outer + depth_[i] * down);
            if (!room) {
                kind_[i] = Kind::bounded;
                continue;
            }
            rise_ = std::min(rise_, edges_[i].inner.z - room->level);
            lower_area_ = std::max(lower_area_, room->area);
        }
    }

    bool is_top_of_body() const {
        const auto falling = static_cast<std::size_t>(std::count(kind_.begin(), kind_.end(), Kind::falls));
        const double share = static_cast<double>(falling) / static_cast<double>(kind_.size());
        if (share < solid_share || has_stairs()) return false;
        const FloorCells::Part& part = storey_.parts()[part_];
        // A storey of a building without outer walls is large, and people can stand below it.
        if (share >= nearly_all) return part.area <= large_share * lower_area_ || !has_space_beneath();
        const bool is_wide = part.breadth > std::min(wide, wide_share * rise_);
        const bool is_large = part.area > (is_wide ? small_share : large_share) * lower_area_;
        return !is_large && !has_space_beneath();
    }

  private:
    enum class Kind : std::uint8_t { bounded, level, falls };

    /// First face along a ray.
    RayHit hit(const Point& from, const Vec3& direction) const {
        RayHit out;
        tracer_.nearest(std::span(&direction, 1), from, RegionId(), std::span(&out, 1));
        return out;
    }

    bool is_blocked(const Point& p, const Point& q) const {
        bool blocked = false;
        tracer_.occluded(std::span(&p, 1), std::span(&q, 1), RegionId(), RegionId(), std::span(&blocked, 1));
        return blocked;
    }

    /// Height from which a ray looks for the floor below a place, metres.
    double above() const { return step_ + apart; }

    Kind kind_of(std::size_t i) {
        const FloorCells::Edge& edge = edges_[i];
        if (edge.has_wall || has_railing(edge)) return Kind::bounded;
        const RayHit below = hit(edge.outer - above() * down, down);
        if (below.surface.is_none()) return Kind::bounded;  // the end of the scene
        depth_[i] = below.distance - above();
        return depth_[i] > step_ ? Kind::falls : Kind::level;
    }

    /// True if a parapet, a railing or a pane is at the edge: something at the height at which these end, and behind it
    /// a place to stand. Goods along the edge of a rack have no such place behind them.
    bool has_railing(const FloorCells::Edge& edge) const {
        constexpr double lowest = 0.5, highest = 1.25;             // metres; derived from parapets and railings
        constexpr double lowest_share = 0.2, highest_share = 0.5;  // of the height, derived from rooms of 2.5 m
        constexpr std::size_t rays = 32;                           // derived from handrails of 2.5 cm
        const double low = std::min(lowest, lowest_share * height_), high = std::min(highest, highest_share * height_);
        const Point start = edge.inner - (edge.outer - edge.inner);
        std::array<Point, rays> from, to;
        std::array<bool, rays> blocked{};
        for (std::size_t k = 0; k < rays; ++k) {
            const double z = low + (high - low) * static_cast<double>(k) / static_cast<double>(rays - 1);
            from[k] = start - z * down, to[k] = edge.outer - z * down;
        }
        tracer_.occluded(from, to, RegionId(), RegionId(), blocked);
        for (std::size_t k = 0; k < rays; ++k)
            if (blocked[k] && !is_in_body_behind(edge, from[k])) return true;
        return std::any_of(scene_.panes().begin(), scene_.panes().end(),
                           [&](const Pane& pane) { return crosses(pane, from.back(), to.back()); });
    }

    /// True if the point behind a place at an edge that is farther from the edge than parapets are thick is in a body.
    bool is_in_body_behind(const FloorCells::Edge& edge, const Point& place) const {
        constexpr double thickest = 0.6;         // metres; derived from parapets of stone, and racks of 0.8 m and more
        constexpr double thickest_share = 0.24;  // of the height, derived from rooms of 2.5 m
        constexpr double breadth_share = 0.75;   // of the part's breadth, derived from goods of a rack's whole depth
        const double depth =
            std::min({thickest, thickest_share * height_, breadth_share * storey_.parts()[part_].breadth});
        const Vec3 inwards = normalized(edge.inner - edge.outer);
        const Point behind = place + (depth - dot(place - edge.outer, inwards)) * inwards;
        const RayHit above = hit(behind, -1 * down);
        return !above.surface.is_none() && !above.front && !above.is_glass;
    }

    static bool crosses(const Pane& pane, const Point& p, const Point& q) {
        const double a = dot(pane.n, p - pane.corners[0]), b = dot(pane.n, q - pane.corners[0]);
        if (a * b > 0 || a == b) return false;
        return contains(pane.corners, pane.n, p + a / (a - b) * (q - p));
    }

    /// True if steps or ramps lead from the outline to places that are several steps lower or higher. Follows the
    /// lowest places first.
    bool has_stairs() const {
        constexpr double steps = 4;     // number of steps; derived from stacks of boxes, which have fewer
        constexpr double tread = 0.12;  // metres; derived from half the depth of treads
        const double size = storey_.cell_size();
        const double spacing = size / std::ceil(size / std::min(tread, step_));
        const Vec3 first = edges_[0].outer - edges_[0].inner;
        const Vec3 u = spacing * normalized(first), v = cross(Vec3{0, 0, 1}, u);
        const Point origin = edges_[0].inner;
        const double level = origin.z;
        using Place = std::pair<int, int>;
        std::map<Place, double> known;  // height of each place, metres
        std::priority_queue<std::pair<double, Place>, std::vector<std::pair<double, Place>>, std::greater<>> open;
        const auto at = [&](const Place& p, double z) {
            Point out = origin + p.first * u + p.second * v;
            out.z = z;
            return out;
        };
        const auto add = [&](const Place& p, double z) {
            if (known.emplace(p, z).second) open.emplace(z, p);
        };
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (kind_[i] != Kind::level) continue;
            const Vec3 d = edges_[i].outer - origin;
            add({static_cast<int>(std::lround(dot(d, u) / (spacing * spacing))),
                 static_cast<int>(std::lround(dot(d, v) / (spacing * spacing)))},
                edges_[i].outer.z - depth_[i]);
        }
        while (!open.empty() && known.size() < max_places) {
            const auto [z, place] = open.top();
            open.pop();
            if (std::abs(z - level) >= steps * step_) return true;
            for (const auto& way : std::array<Place, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
                const Place next{place.first + way.first, place.second + way.second};
                if (known.contains(next)) continue;
                const Point q = at(next, z) - above() * down;
                const RayHit below = hit(q, down);
                const double there = q.z - below.distance;
                if (below.surface.is_none() || std::abs(there - z) > step_) continue;
                if (std::abs(there - level) < one_plane && storey_.floor().holds(at(next, level))) continue;
                const Vec3 rise = 2 * above() * down;
                if (!is_blocked(at(place, z) - rise, at(next, z) - rise)) add(next, there);
            }
        }
        return false;
    }

    /// True if people can stand beneath most of the part: below a slab, or below a sheet whose sides are open.
    bool has_space_beneath() const {
        const std::size_t cells = storey_.parts()[part_].cells;
        const std::size_t stride = std::max<std::size_t>(1, cells / sampled_cells);
        std::size_t seen = 0, used = 0, free = 0, sheet = 0;
        for (std::size_t i = 0; i < storey_.size(); ++i) {
            if (storey_.part(i) != part_ || seen++ % stride != 0) continue;
            const Beneath found = beneath(storey_.centre(i));
            ++used, free += found == Beneath::space, sheet += found == Beneath::sheet_or_solid;
        }
        if (2 * free >= used) return true;
        return 2 * (free + sheet) >= used && has_open_sides();
    }

    enum class Beneath : std::uint8_t { solid, sheet_or_solid, space };

    double space() const { return std::min(standing_height, standing_share * rise_); }

    Beneath beneath(const Point& top) const {
        constexpr int max_layers = 8;  // derived from a slab with a lowered ceiling and ducts below it
        Point p = top + apart * down;
        bool is_inside = true;
        for (int layer = 0; layer < max_layers; ++layer) {
            const RayHit next = hit(p, down);
            if (next.surface.is_none() || top.z - p.z + next.distance > rise_ + 2 * apart) return Beneath::solid;
            const bool is_high = next.distance >= space();
            if (next.front && is_high) return is_inside ? Beneath::sheet_or_solid : Beneath::space;
            is_inside = next.front;
            p += (next.distance + apart) * down;
        }
        return Beneath::solid;
    }

    /// True if, at most places where the outline falls, nothing closes the side below it.
    bool has_open_sides() const {
        constexpr std::size_t heights = 8;
        constexpr double inwards = 3;  // cells; derived from plates that jut out over their frames
        std::size_t falling = 0, open = 0;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (kind_[i] != Kind::falls) continue;
            const Vec3 way = edges_[i].inner - edges_[i].outer;
            std::size_t blocked = 0;
            for (std::size_t k = 0; k < heights; ++k) {
                const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(heights);
                const Point q = edges_[i].outer + share * depth_[i] * down;
                blocked += is_blocked(q, q + inwards * way);
            }
            ++falling, open += 2 * blocked < heights;
        }
        return 2 * open > falling;
    }

    const Scene& scene_;
    const RayTracer& tracer_;
    const FloorCells& storey_;
    std::uint32_t part_;
    double height_, step_;    ///< Metres.
    double rise_ = HUGE_VAL;  ///< Height above the floor of the nearest lower room, metres.
    double lower_area_ = 0;   ///< Area of the largest lower room, m^2.
    std::vector<FloorCells::Edge> edges_;
    std::vector<double> depth_;  ///< Depth of the first face below each edge's outer point, metres.
    std::vector<Kind> kind_;
};

}  // namespace

bool is_top_of_body(const Scene& scene, const RayTracer& tracer, const FloorCells& storey, std::uint32_t part,
                    const FindLowerRoom& find_lower_room) {
    return Bounds(scene, tracer, storey, part, find_lower_room).is_top_of_body();
}

}  // namespace exitance

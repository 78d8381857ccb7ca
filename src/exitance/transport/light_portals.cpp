#include "exitance/transport/light_portals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "exitance/base/limits.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

constexpr unsigned max_portal_rays = 1 << 18;  ///< Rays that search for openings, in total.
constexpr unsigned ray_batch = 1 << 10;        ///< Rays of a room that are cast in succession.
/// The search stops after this number of rays through a room's openings, since more rays rarely find other openings.
constexpr std::size_t enough_rays = 64;
constexpr std::size_t max_openings = 8;  ///< Maximum number of openings between two rooms.
constexpr std::size_t max_cells = 16;    ///< Maximum number of parallelograms at which rays of one room are aimed.

/// A ray from one room into another.
struct CrossingRay {
    Point from, to;
    std::size_t into;
};

/// Finds openings between rooms by rays.
class PortalFinder {
  public:
    PortalFinder(const Stage& stage, const LightRooms& rooms, const ElementTree& tree, const LeafNumbering& numbering,
                 std::uint64_t seed)
        : stage_(stage), rooms_(rooms), tree_(tree), leaves_(rooms.count()), seed_(seed) {
        for (ElementId e : numbering.leaves) leaves_[rooms.of(tree, e)].push_back(e);
        Box box;
        for (const Piece& piece : stage.pieces) box.add(piece.patch.centre());
        largest_ = std::max(box.diagonal(), min_divisor);
    }

    /// Casts up to `most` rays from a room and returns those that arrive in a larger room.
    std::vector<CrossingRay> crossing_rays(std::size_t room, unsigned most, const StopRequest& stop) const;

    /// The opening that a ray passes through; of area 0 if too few lines through its neighbourhood find it.
    PortalCell opening(std::size_t room, const CrossingRay& ray) const;

  private:
    static constexpr std::size_t none = ~std::size_t{0};
    /// A plane near an opening: a point and a frame whose normal leads to the other room.
    struct Crossing {
        Point at;
        Frame frame;

        Vec2 in_plane(const Vec3& d) const { return {dot(d, frame.u), dot(d, frame.v)}; }
        Point in_space(const Vec2& q) const { return at + q.x * frame.u + q.y * frame.v; }
    };
    /// Points corner + s u + t v with s and t in [0, 1), in the coordinates of a plane.
    struct SearchedRectangle {
        Vec2 corner, u, v;
    };
    /// Points of a plane through which lines lead from one room into the other, and the directions of the lines.
    struct OpenPoints {
        std::vector<Vec2> points;
        std::vector<Vec3> directions;
    };
    /// Writes the room at the hit of each ray from a point of free space; `none` if it hits no front.
    void look(const Point& from, std::span<const Vec3> directions, std::vector<std::size_t>& met) const;
    Point middle(std::size_t room, const CrossingRay& ray) const;
    Normal normal(std::size_t room, const CrossingRay& ray, const Point& at) const;
    /// Casts `lines` lines through a rectangle in the plane of `crossing`. Finds those that end in one room on one side
    /// and in the other room on the other.
    OpenPoints open_points(std::size_t room, std::size_t other, const Crossing& crossing, const SearchedRectangle& in,
                           unsigned lines, std::uint64_t key) const;
    OpenPoints first_points(std::size_t room, std::size_t other, const Crossing& crossing, std::uint64_t key) const;
    PortalCell surrounded(std::size_t room, std::size_t other, const Crossing& crossing, OpenPoints& open,
                          std::uint64_t key) const;
    Crossing straightened(std::size_t room, std::size_t other, const Crossing& crossing, const PortalCell& cell,
                          const OpenPoints& open) const;

    const Stage& stage_;
    const LightRooms& rooms_;
    const ElementTree& tree_;
    std::vector<std::vector<ElementId>> leaves_;  ///< Leaves of each room.
    std::uint64_t seed_;
    double largest_;  ///< Size of the scene: limit on the size of an opening, metres.
};

std::vector<CrossingRay> PortalFinder::crossing_rays(std::size_t room, unsigned most, const StopRequest& stop) const {
    std::vector<CrossingRay> out;
    double area = 0;
    for (ElementId e : leaves_[room]) area += tree_.area(e);
    const ScrambledSobol points(hash(seed_, static_cast<std::uint64_t>(Stream::visibility), room));
    for (unsigned first = 0; first < most && out.size() < enough_rays && !stop.requested(); first += ray_batch) {
        double before = 0;
        std::size_t leaf = 0;
        for (unsigned k = 0; k < ray_batch; ++k) {
            const double wanted = area * (k + 0.5) / ray_batch;
            while (leaf + 1 < leaves_[room].size() && before + tree_.area(leaves_[room][leaf]) <= wanted)
                before += tree_.area(leaves_[room][leaf]), ++leaf;
            const ElementId e = leaves_[room][leaf];
            const unsigned i = first + k;
            const RegionId region = tree_.region(e);
            const Point x = tree_.patch(e).at(tree_.uniform(e, points(i, 2), points(i, 3)));
            const Vec3 w = cosine_direction(Frame(stage_.scene.regions()[region].plane.n), points(i, 0), points(i, 1));
            RayHit hit;
            stage_.tracer.nearest(std::span(&w, 1), x, region, std::span(&hit, 1));
            if (hit.surface.is_none() || !hit.front || stage_.is_unlit(hit.region)) continue;
            const Point y = x + hit.distance * w;
            const std::size_t into = rooms_.at(hit.region, y);
            if (into < room) out.push_back({x, y, into});
        }
    }
    return out;
}

void PortalFinder::look(const Point& from, std::span<const Vec3> directions, std::vector<std::size_t>& met) const {
    std::vector<RayHit> hits(directions.size());
    stage_.tracer.nearest(directions, from, RegionId(), hits);
    met.assign(directions.size(), none);
    for (std::size_t k = 0; k < directions.size(); ++k)
        if (!hits[k].surface.is_none() && hits[k].front && !stage_.is_unlit(hits[k].region))
            met[k] = rooms_.at(hits[k].region, from + hits[k].distance * directions[k]);
}

/// Point of the ray from which equally much is visible of both rooms.
Point PortalFinder::middle(std::size_t room, const CrossingRay& ray) const {
    constexpr int halvings = 12;
    const std::vector<Vec3> directions = directions_all_around(256);
    std::vector<std::size_t> met;
    double lo = 0, hi = 1;
    for (int i = 0; i < halvings; ++i) {
        const double t = 0.5 * (lo + hi);
        look(ray.from + t * (ray.to - ray.from), directions, met);
        const auto own = std::count(met.begin(), met.end(), room), other = std::count(met.begin(), met.end(), ray.into);
        (own > other ? lo : hi) = t;
    }
    return ray.from + 0.5 * (lo + hi) * (ray.to - ray.from);
}

/// Normal of the opening, from `room` to the other room: the mean of the directions in which each is visible, with
/// opposite signs.
Normal PortalFinder::normal(std::size_t room, const CrossingRay& ray, const Point& at) const {
    const std::vector<Vec3> directions = directions_all_around(1024);
    std::vector<std::size_t> met;
    look(at, directions, met);
    Vec3 sum;
    for (std::size_t k = 0; k < met.size(); ++k) {
        if (met[k] == ray.into) sum += directions[k];
        if (met[k] == room) sum -= directions[k];
    }
    // Shorter sums have no clear direction. Chosen: half of it and twice it give the same light, measured by
    // `exitance solve door.obj --error 0.02`.
    constexpr double min_mean = 0.1;
    const bool tells = norm(sum) > min_mean * static_cast<double>(met.size());
    return normalized(tells ? sum : ray.to - ray.from);
}

PortalFinder::OpenPoints PortalFinder::open_points(std::size_t room, std::size_t other, const Crossing& crossing,
                                                   const SearchedRectangle& in, unsigned lines,
                                                   std::uint64_t key) const {
    const ScrambledSobol points(key);
    OpenPoints out;
    std::vector<std::size_t> met;
    for (unsigned k = 0; k < lines; ++k) {
        const Vec2 q = in.corner + points(k, 2) * in.u + points(k, 3) * in.v;
        const Vec3 w = cosine_direction(crossing.frame, points(k, 0), points(k, 1));
        look(crossing.in_space(q), std::array{w, -w}, met);
        if (met[0] == other && met[1] == room) out.points.push_back(q), out.directions.push_back(w);
    }
    return out;
}

/// Doubles a search square until the half of it that surrounds all points found so far contains no more.
PortalFinder::OpenPoints PortalFinder::first_points(std::size_t room, std::size_t other, const Crossing& crossing,
                                                    std::uint64_t key) const {
    constexpr unsigned lines = 256;
    OpenPoints out;
    double reach = 0;
    for (double half = 0x1p-14 * largest_; half < largest_; half *= 2) {
        OpenPoints found =
            open_points(room, other, crossing, {{-half, -half}, {2 * half, 0}, {0, 2 * half}}, lines, key);
        double farthest = 0;
        for (const Vec2& p : found.points) farthest = std::max({farthest, std::abs(p.x), std::abs(p.y)});
        if (reach > 0 && farthest <= 0.5 * half) break;
        if (farthest > reach) out = std::move(found), reach = farthest;
    }
    return out;
}

/// Returns a rectangle that covers an opening, given some points in the opening. These may miss parts of it, since few
/// random lines through a square pass through a slit. The opening is therefore searched by further lines, through the
/// rectangle that surrounds the points found so far and through its neighbourhood, until the rectangle no longer grows.
/// If a part of the opening were not covered, the rays that find it by chance would cause most of the noise.
PortalCell PortalFinder::surrounded(std::size_t room, std::size_t other, const Crossing& crossing, OpenPoints& open,
                                    std::uint64_t key) const {
    constexpr unsigned lines = 512;
    constexpr int max_searches = 8;
    constexpr std::size_t min_points = 8;  // number of points from which a rectangle can be found
    // Neighbourhood on each side, as a share of the rectangle's size. Chosen: half of it takes 37% more rays and
    // twice it the same number, measured by `exitance solve door.obj --error 0.02`.
    constexpr double around = 0.25;
    constexpr double grows =
        1.02;  // factor on the area below which it counts as unchanged: derived from 512 random lines
    if (open.points.empty()) return {};
    PortalCell out;
    for (int i = 0; i < max_searches; ++i) {
        const PortalCell before = std::exchange(out, rectangle_around(crossing.at, crossing.frame, open.points));
        if (i > 1 && out.area <= grows * before.area) break;
        const Vec2 u = crossing.in_plane(out.u), v = crossing.in_plane(out.v);
        const Vec2 corner = crossing.in_plane(out.corner - crossing.at) - around * u - around * v;
        const OpenPoints found = open_points(room, other, crossing,
                                             {corner, (1 + 2 * around) * u, (1 + 2 * around) * v}, lines, hash(key, i));
        open.points.insert(open.points.end(), found.points.begin(), found.points.end());
        open.directions.insert(open.directions.end(), found.directions.begin(), found.directions.end());
    }
    return open.points.size() < min_points ? PortalCell() : out;
}

/// Turns the plane of a long opening such that it contains the middles of lines at both ends.
PortalFinder::Crossing PortalFinder::straightened(std::size_t room, std::size_t other, const Crossing& crossing,
                                                  const PortalCell& cell, const OpenPoints& open) const {
    const Vec3 along = squared_norm(cell.u) > squared_norm(cell.v) ? cell.u : cell.v;
    const Vec2 on_plane = crossing.in_plane(normalized(along));
    const auto position = [&](std::size_t k) { return open.points[k].x * on_plane.x + open.points[k].y * on_plane.y; };
    std::size_t first = 0, last = 0;
    for (std::size_t k = 0; k < open.points.size(); ++k) {
        if (position(k) < position(first)) first = k;
        if (position(k) > position(last)) last = k;
    }
    const auto middle_at = [&](std::size_t k) {
        // The line extends from the point to both sides by the length of the opening, or to the first surface.
        const Point p = crossing.in_space(open.points[k]);
        const Vec3& w = open.directions[k];
        std::array<RayHit, 2> hits;
        stage_.tracer.nearest(std::array{w, -w}, p, RegionId(), hits);
        const auto reach = [&](const RayHit& hit) { return std::min(norm(along), hit.distance); };
        return middle(room, {p - reach(hits[1]) * w, p + reach(hits[0]) * w, other});
    };
    const Point a = middle_at(first), b = middle_at(last);
    const Vec3 u = normalized(b - a);
    // Both middles are within the opening unless an object is in it. The plane then turns; limit its angle. Chosen;
    // 0.45 takes 24% more rays and 1, which keeps the first plane, as many, measured by `exitance solve door.obj
    // --error 0.02`.
    constexpr double min_cosine = 0.9;
    const Vec3 n = crossing.frame.n - dot(crossing.frame.n, u) * u;
    if (!(norm(n) > min_cosine) || !(std::abs(dot(u, normalized(along))) > min_cosine)) return crossing;
    return {a + 0.5 * (b - a), Frame(normalized(n))};
}

PortalCell PortalFinder::opening(std::size_t room, const CrossingRay& ray) const {
    const Point at = middle(room, ray);
    Crossing crossing{at, Frame(normal(room, ray, at))};
    const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::visibility), room, ray.into);
    OpenPoints open = first_points(room, ray.into, crossing, key);
    PortalCell best = surrounded(room, ray.into, crossing, open, key);
    if (!(best.area > 0)) return best;
    // The plane found first may be in front of the wall or oblique to it. Lines then also cross it beside the opening,
    // and the rectangle is too large.
    crossing = straightened(room, ray.into, crossing, best, open);
    OpenPoints again = open_points(
        room, ray.into, crossing,
        {crossing.in_plane(best.corner - crossing.at), crossing.in_plane(best.u), crossing.in_plane(best.v)}, 512,
        hash(key, 8));
    if (const PortalCell cell = surrounded(room, ray.into, crossing, again, hash(key, 9)); cell.area > 0) best = cell;
    return best;
}

/// Irradiance of the coarse elements from all sources, including those without emitting polygons: the mean over some
/// elements of each room, W/m^2.
std::vector<Spectrum> apart_light(const Stage& stage, const LightRooms& rooms, const ElementTree& tree,
                                  const LeafNumbering& numbering) {
    constexpr std::size_t samples = 64;  // number of points per room
    std::vector<std::vector<std::size_t>> of_room(rooms.count());
    for (std::size_t i = 0; i < numbering.leaves.size(); ++i) of_room[rooms.of(tree, numbering.leaves[i])].push_back(i);
    std::vector<Spectrum> out(numbering.leaves.size());
    PlaceLight::Workspace workspace;
    for (const std::vector<std::size_t>& leaves : of_room) {
        const std::size_t step = std::max<std::size_t>(1, leaves.size() / samples);
        Spectrum sum;
        double area = 0;
        for (std::size_t k = step / 2; k < leaves.size(); k += step) {
            const ElementId e = numbering.leaves[leaves[k]];
            const RegionId region = tree.region(e);
            const Normal& n = stage.scene.regions()[region].plane.n;
            const Point x = tree.patch(e).at(tree.centre(e));
            // Chosen: half of it and twice it give the same light, measured by `exitance solve office.obj --error
            // 0.02`.
            constexpr LightAccuracy rough{.relative = 0.1};
            sum += tree.area(e) * stage.place_light.at(x, n, region, rough, workspace).irradiance;
            area += tree.area(e);
        }
        for (std::size_t i : leaves) out[i] = area > 0 ? sum / area : Spectrum();
    }
    return out;
}

}  // namespace

std::vector<double> coarse_light(const Stage& stage, const LightRooms& rooms, const ElementTree& tree,
                                 const LeafNumbering& numbering, const RayRows& rows) {
    constexpr int reflections = 30;
    const std::size_t n = numbering.leaves.size();
    std::vector<double> area(rooms.count()), light(rooms.count());
    std::vector<Spectrum> first(n), b(n), arriving(n);
    for (std::size_t i = 0; i < n; ++i) {
        b[i] = stage.scene.material(tree.region(numbering.leaves[i])).exitance;
        area[rooms.of(tree, numbering.leaves[i])] += tree.area(numbering.leaves[i]);
    }
    rows.gather(b, first);
    if (stage.scene.has_light_apart()) first = apart_light(stage, rooms, tree, numbering);
    std::fill(b.begin(), b.end(), Spectrum());
    for (int k = 0; k < reflections; ++k) {
        if (k > 0) rows.gather(b, arriving);
        for (std::size_t i = 0; i < n; ++i)
            b[i] = stage.scene.material(tree.region(numbering.leaves[i])).reflectance * (first[i] + arriving[i]);
    }
    for (std::size_t i = 0; i < n; ++i)
        light[rooms.of(tree, numbering.leaves[i])] += tree.area(numbering.leaves[i]) * mean(b[i]);
    for (std::size_t room = 0; room < light.size(); ++room) light[room] /= area[room] > 0 ? area[room] : 1;
    return light;
}

bool LightPortals::empty() const {
    return std::all_of(by_room_.begin(), by_room_.end(), [](const auto& cells) { return cells.empty(); });
}

std::shared_ptr<const LightPortals> find_light_portals(const Stage& stage, const LightRooms& rooms,
                                                       const ElementTree& tree, const LeafNumbering& numbering,
                                                       std::span<const double> light, std::uint64_t seed,
                                                       const StopRequest& stop) {
    const PortalFinder finder(stage, rooms, tree, numbering, seed);
    const auto most = std::max(ray_batch, static_cast<unsigned>(max_portal_rays / rooms.count()));
    std::vector<std::vector<PortalCell>> by_room(rooms.count());
    for (std::size_t room = rooms.count(); room-- > 1 && !stop.requested();) {
        std::vector<CrossingRay> rays = finder.crossing_rays(room, most, stop);
        std::vector<std::size_t> openings(rooms.count());
        while (!rays.empty() && !stop.requested()) {
            const CrossingRay ray = rays.back();
            rays.pop_back();
            if (openings[ray.into] == max_openings) continue;
            PortalCell found = finder.opening(room, ray);
            if (!(found.area > 0)) continue;
            ++openings[ray.into];
            std::erase_if(rays, [&](const CrossingRay& other) {
                return other.into == ray.into && passes_near(other.from, other.to - other.from, found);
            });
            const std::size_t darker = light[room] < light[ray.into] ? room : ray.into;
            const double share = found.area / rooms.area(darker), bright = std::max(light[room], light[ray.into]);
            // The ratio of light is limited by the light that comes in through the opening.
            const double more = bright > 0 ? bright / std::max(light[darker], share * bright) : 0;
            found.light = more;
            if (is_worth_aiming(share, more)) add_portal_cells(found, max_cells, by_room[darker]);
        }
    }
    auto out = std::make_shared<const LightPortals>(std::move(by_room));
    return out->empty() ? nullptr : out;
}

std::span<const PortalCell> portals_worth_aiming(const Stage& stage, RegionId own, const Point& x, const Normal& n) {
    const LightPortals* portals = stage.rooms.portals();
    if (!portals || own.is_none()) return {};
    return worth_aiming(stage, own, portals->of_room(stage.rooms.at(own, x)), x, n);
}

std::span<const PortalCell> worth_aiming(const Stage& stage, RegionId own, std::span<const PortalCell> cells,
                                         const Point& x, const Normal& n) {
    if (cells.empty() || !stage.scene.behind(own).is_none()) return {};
    double worth = 0;
    for (const PortalCell& cell : cells) worth += PortalAim::form_factor(cell, x, n) * cell.light * cell.light;
    return worth > 1 ? cells : std::span<const PortalCell>();
}

}  // namespace exitance

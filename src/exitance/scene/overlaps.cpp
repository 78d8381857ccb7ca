#include "exitance/scene/overlaps.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/geometry/triangulation.hpp"
#include "exitance/scene/cell_keys.hpp"

namespace exitance {
namespace {

/// Overlaps below this share of the smaller face are rounding.
constexpr double negligible = 1e-6;

struct PlaneEntry {
    std::uint64_t key;
    std::uint32_t region;
    auto operator<=>(const PlaneEntry&) const = default;
};

/// The box of a face or region in a plane's coordinates.
struct FlatBox {
    Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};

    void add(const Vec2& p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    bool overlaps(const FlatBox& o, double tolerance) const {
        return std::min(hi.x, o.hi.x) - std::max(lo.x, o.lo.x) > tolerance &&
               std::min(hi.y, o.hi.y) - std::max(lo.y, o.lo.y) > tolerance;
    }
};

/// Does the smaller region lie in the larger one's plane, facing the same way?
bool share_plane(const Region* a, const Region* b, double tolerance) {
    if (dot(a->plane.n, b->plane.n) <= 0) return false;
    if (a->area < b->area) std::swap(a, b);
    return std::all_of(b->loops.begin(), b->loops.end(), [&](const std::vector<Point>& loop) {
        return std::all_of(loop.begin(), loop.end(),
                           [&](const Point& p) { return std::abs(a->plane.signed_distance(p)) <= tolerance; });
    });
}

/// The convex piece's part within another one, m^2.
double common_area(std::span<const Point> a, std::span<const Point> b, const Normal& n) {
    std::vector<Point> part(a.begin(), a.end()), next;
    for (std::size_t i = 0; i < b.size() && !part.empty(); ++i) {
        const Normal inwards = normalized(cross(n, b[(i + 1) % b.size()] - b[i]));
        clip(part, {inwards, dot(inwards, b[i])}, next);
        std::swap(part, next);
    }
    return part.empty() ? 0 : norm(area_vector(part));
}

double common_area(const Scene& scene, SurfaceId a, SurfaceId b) {
    const Normal& n = scene.surfaces()[a].normal;
    const auto convex = [&](SurfaceId s) {
        std::vector<std::vector<Point>> out;
        for (const auto& piece : convex_pieces(scene.outline(s), n)) {
            out.emplace_back();
            for (std::uint32_t c : piece) out.back().push_back(scene.outline(s)[c]);
        }
        return out;
    };
    double sum = 0;
    const auto pieces = convex(b);
    for (const auto& p : convex(a))
        for (const auto& q : pieces) sum += common_area(p, q, n);
    return sum;
}

/// The pair of faces of two regions that overlaps most, if any does.
void compare(const Scene& scene, RegionId a, RegionId b, const Frame& frame, double tolerance,
             std::vector<Overlap>& out) {
    const auto box = [&](SurfaceId s) {
        FlatBox flat;
        for (const Point& p : scene.outline(s)) flat.add({dot(p, frame.u), dot(p, frame.v)});
        return flat;
    };
    Overlap most{{}, {}, 0};
    std::vector<std::pair<SurfaceId, FlatBox>> boxes;
    for (SurfaceId s : scene.regions()[b].surfaces) boxes.push_back({s, box(s)});
    for (SurfaceId s : scene.regions()[a].surfaces) {
        const FlatBox own = box(s);
        for (const auto& [t, other] : boxes) {
            if (!own.overlaps(other, tolerance)) continue;
            const double area = common_area(scene, s, t);
            const double least = negligible * std::min(scene.surfaces()[s].area, scene.surfaces()[t].area);
            if (area > least && area > most.area) most = {std::min(s, t), std::max(s, t), area};
        }
    }
    if (most.area > 0) out.push_back(most);
}

/// Sweeps over the regions of one plane.
void compare_all(const Scene& scene, std::span<const PlaneEntry> group, double tolerance, std::vector<Overlap>& out) {
    const Frame frame(scene.regions()[RegionId(group[0].region)].plane.n);
    struct Placed {
        FlatBox box;
        RegionId region;
    };
    std::vector<Placed> placed, open;
    for (const PlaneEntry& entry : group) {
        placed.push_back({{}, RegionId(entry.region)});
        for (const auto& loop : scene.regions()[RegionId(entry.region)].loops)
            for (const Point& p : loop) placed.back().box.add({dot(p, frame.u), dot(p, frame.v)});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.box.lo.x != b.box.lo.x ? a.box.lo.x < b.box.lo.x : a.region < b.region;
    });
    for (const Placed& p : placed) {
        std::erase_if(open, [&](const Placed& o) { return o.box.hi.x <= p.box.lo.x; });
        for (const Placed& o : open) {
            const Region &a = scene.regions()[o.region], &b = scene.regions()[p.region];
            if (o.box.overlaps(p.box, tolerance) && share_plane(&a, &b, tolerance))
                compare(scene, o.region, p.region, frame, tolerance, out);
        }
        open.push_back(p);
    }
}

}  // namespace

std::vector<Overlap> find_overlaps(const Scene& scene, double tolerance) {
    std::vector<PlaneEntry> entries;
    const double size = scene.size(), tilt = 1e-6;
    for (RegionId id : scene.regions().ids()) {
        const Plane& plane = scene.regions()[id].plane;
        const double offset = plane.offset - dot(plane.n, scene.box().centre());
        const auto direction = [&](double x) { return CellCoordinate{x, 1e-3, tilt}; };
        each_cell_key<4>(0,
                         {direction(plane.n.x), direction(plane.n.y), direction(plane.n.z),
                          CellCoordinate{offset, 1e-4 * size, tolerance + tilt * size}},
                         [&](std::uint64_t key) {
                             entries.push_back({key, id.value});
                         });
    }
    std::sort(entries.begin(), entries.end());
    std::vector<Overlap> out;
    for (std::size_t i = 0, j; i < entries.size(); i = j) {
        for (j = i + 1; j < entries.size() && entries[j].key == entries[i].key;) ++j;
        if (j - i > 1) compare_all(scene, std::span(entries).subspan(i, j - i), tolerance, out);
    }
    const auto ids = [](const Overlap& o) { return std::pair(o.first, o.second); };
    std::sort(out.begin(), out.end(), [&](const Overlap& a, const Overlap& b) { return ids(a) < ids(b); });
    out.erase(std::unique(out.begin(), out.end(), [&](const Overlap& a, const Overlap& b) { return ids(a) == ids(b); }),
              out.end());
    return out;
}

}  // namespace exitance

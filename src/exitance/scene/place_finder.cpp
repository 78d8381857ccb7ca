#include "exitance/scene/place_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/scene/outline_distance.hpp"

namespace exitance {

/// A face or a pane.
struct PlaceFinder::Wall {
    std::span<const Point> outline;
    Normal n;
    SurfaceId surface;  ///< The face; none for a pane, both sides of which count as fronts.
};

/// A half-line from the point in its measuring plane, along which a wall extends.
struct PlaceFinder::Blade {
    Wall wall;
    Vec3 way;       ///< Unit vector along the wall.
    double angle;   ///< Angle of `way`, from 0 to 2 pi.
    Vec3 across;    ///< Unit vector in the measuring plane, towards the wall's front.
    double before;  ///< Distance of the point in front of the wall along `across`, metres.
};

/// The sector between two neighbouring blades.
struct PlaceFinder::Sector {
    Point place;              ///< The point, moved into the sector.
    Vec3 inwards;             ///< Unit vector along the bisector.
    int backs = 0;            ///< Number of the sector's two sides that are backs of walls.
    bool holds_point = true;  ///< True if the point is in the sector, by more than rounding.
    bool is_reflex = false;   ///< True if the sector's angle is more than pi.
    /// Among the faces whose fronts bound it, the one with the lowest id; none if there are only panes.
    SurfaceId front;
    bool is_before_pane = false;  ///< True if the sector is on the side to which a pane's normal points.
};

namespace {

constexpr double min_blade_angle = 1e-3;  ///< Radians; blades at a smaller angle count as one.
/// Relative to the scene's diameter; rays start at the same distance from their surfaces.
constexpr double step_share = 0x1p-20;
constexpr double slack = 1 + 0x1p-10;  ///< Prevents that a point already moved is moved again because of rounding.
/// Distance from a wall, in steps, beyond which a point is clearly on one side of it. Coordinates rounded to twelve
/// digits, a hundred scene sizes from the origin, have an error of a ten-thousandth of a step.
constexpr double min_offset = 1e-3;

Point area_centroid(const Scene& scene) {
    Vec3 sum;
    double area = 0;
    for (const Surface& s : scene.surfaces()) area += s.area;
    for (const SurfaceId s : scene.surfaces().ids())
        sum += (scene.surfaces()[s].area / area) * (centroid(scene.outline(s)) - scene.box().centre());
    return area > 0 ? scene.box().centre() + sum : scene.box().centre();
}

}  // namespace

PlaceFinder::PlaceFinder(const Scene& scene) : scene_(&scene), locator_(scene), centroid_(area_centroid(scene)) {
    double radius = 0;
    for (const SurfaceId s : scene.surfaces().ids())
        for (const Point& p : scene.outline(s)) radius = std::max(radius, norm(p - centroid_));
    for (const Pane& pane : scene.panes())
        for (const Point& p : pane.corners) radius = std::max(radius, norm(p - centroid_));
    step_ = step_share * 2 * radius;
    std::vector<Box> boxes(scene.surfaces().size() + scene.panes().size());
    for (const SurfaceId s : scene.surfaces().ids())
        for (const Point& p : scene.outline(s)) boxes[s.value].add(p);
    for (std::size_t i = 0; i < scene.panes().size(); ++i)
        for (const Point& p : scene.panes()[i].corners) boxes[scene.surfaces().size() + i].add(p);
    for (Box& box : boxes) box.lo -= Vec3{step_, step_, step_}, box.hi += Vec3{step_, step_, step_};
    tree_ = Bvh(boxes);
}

/// True if the wall is nearer to p than `step_`, the tolerance of positions.
bool PlaceFinder::touches(const Wall& wall, const Point& p) const {
    const double height = dot(wall.n, p - wall.outline[0]);
    if (!(std::abs(height) <= step_)) return false;
    if (contains(wall.outline, wall.n, p)) return true;
    return norm(p - nearest_on_border(wall.outline, p)) <= step_;
}

/// True if the wall may block light that arrives at p from above the plane of normal n.
bool PlaceFinder::rises_above(const Wall& wall, const Point& p, const Normal& n) const {
    return std::any_of(wall.outline.begin(), wall.outline.end(),
                       [&](const Point& corner) { return dot(n, corner - p) > step_; });
}

/// Calls visit(wall) for every face and pane that touches p.
template <class Visit>
void PlaceFinder::visit_walls(const Point& p, const Visit& visit) const {
    const std::size_t faces = scene_->surfaces().size();
    tree_.visit_box({p, p}, [&](std::uint32_t i) {
        const Pane* const pane = i < faces ? nullptr : &scene_->panes()[i - faces];
        const SurfaceId s = pane ? SurfaceId() : SurfaceId(i);
        const Wall wall =
            pane ? Wall{pane->corners, pane->n, s} : Wall{scene_->outline(s), scene_->surfaces()[s].normal, s};
        if (touches(wall, p)) visit(wall);
    });
}

/// Returns the blades of all walls that touch p, counter-clockwise. Faces of region `own` are skipped.
std::vector<PlaceFinder::Blade> PlaceFinder::blades_at(const Point& p, const Normal& n, RegionId own) const {
    // In steps, so that a wall that ends within a step of p does not count as continuing beyond it.
    constexpr double look_ahead = 4;
    const Frame frame(n);
    std::vector<Blade> out;
    visit_walls(p, [&](const Wall& wall) {
        const double cosine = dot(wall.n, n), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        if (std::abs(cosine) > parallel_cosine || !rises_above(wall, p, n)) return;
        if (!own.is_none() && !wall.surface.is_none() && scene_->surfaces()[wall.surface].region == own) return;
        const Vec3 across = normalized(wall.n - cosine * n), along = cross(n, across);
        for (const Vec3& way : {along, -along}) {
            if (!touches(wall, p + look_ahead * step_ * way)) continue;
            const double turn = std::atan2(dot(way, frame.v), dot(way, frame.u));
            out.push_back(
                {wall, way, turn < 0 ? turn + 2 * pi : turn, across, dot(wall.n, p - wall.outline[0]) / sine});
        }
    });
    std::stable_sort(out.begin(), out.end(), [](const Blade& a, const Blade& b) { return a.angle < b.angle; });
    return out;
}

/// Makes the sector between the blades `start` and `end`, each of one direction. `angle`: from start to end,
/// counter-clockwise.
PlaceFinder::Sector PlaceFinder::make_sector(const Point& p, const Normal& n, std::span<const Blade> start,
                                             std::span<const Blade> end, double angle) const {
    Sector out;
    out.inwards = std::cos(0.5 * angle) * start[0].way + std::sin(0.5 * angle) * cross(n, start[0].way);
    out.is_reflex = angle > pi + min_blade_angle;
    double way = 0;
    bool is_off_all = true, is_off_any = false;
    for (const bool at_start : {true, false}) {
        const std::span<const Blade> side = at_start ? start : end;
        // direction from the side into the sector
        const Vec3 off = at_start ? cross(n, side[0].way) : cross(side[0].way, n);
        const auto depth = [&](const Blade& b) {  // distance of p from the blade, positive inside the sector
            return b.before * dot(b.across, off);
        };
        double least = HUGE_VAL;
        for (const Blade& b : side) least = std::min(least, depth(b));
        bool is_front = false;
        for (const Blade& b : side) {
            // Among walls behind one another, the outermost bounds the sector.
            if (depth(b) > least + min_offset * step_) continue;
            const bool is_pane = b.wall.surface.is_none(), is_before = dot(b.across, off) > 0;
            is_front |= is_pane || is_before;
            out.is_before_pane |= is_pane && is_before;
            if (!is_pane && is_before && (out.front.is_none() || b.wall.surface < out.front))
                out.front = b.wall.surface;
        }
        out.backs += !is_front;
        const double needed = slack * step_ - least, slope = std::max(dot(out.inwards, off), 1e-6);
        way = std::max(way, out.is_reflex ? slack * step_ + std::abs(least) : needed / slope);
        is_off_all &= least > min_offset * step_, is_off_any |= least > min_offset * step_;
    }
    out.holds_point = out.is_reflex ? is_off_any : is_off_all;
    out.place = p + way * out.inwards;
    return out;
}

std::vector<PlaceFinder::Sector> PlaceFinder::sectors_at(const Point& p, const Normal& n,
                                                         const std::vector<Blade>& blades) const {
    // Blades of one direction form a group; the enumeration begins where two directions differ.
    const std::size_t count = blades.size();
    const auto gap_before = [&](std::size_t i) {
        const double gap = blades[i].angle - blades[i == 0 ? count - 1 : i - 1].angle;
        return i == 0 ? gap + 2 * pi : gap;
    };
    std::size_t first = 0;
    while (first < count && gap_before(first) <= min_blade_angle) ++first;
    if (first == count) return {};
    std::vector<Blade> in_turn(blades.begin() + static_cast<std::ptrdiff_t>(first), blades.end());
    in_turn.insert(in_turn.end(), blades.begin(), blades.begin() + static_cast<std::ptrdiff_t>(first));
    std::vector<std::span<const Blade>> sides;
    for (std::size_t i = 0, begin = 0; i < count; ++i)
        if (i + 1 == count || gap_before((first + i + 1) % count) > min_blade_angle)
            sides.push_back(std::span(in_turn).subspan(begin, i + 1 - begin)), begin = i + 1;
    std::vector<Sector> out;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const std::span<const Blade> start = sides[k], end = sides[(k + 1) % sides.size()];
        double angle = end[0].angle - start[0].angle;
        if (angle <= 0) angle += 2 * pi;
        out.push_back(make_sector(p, n, start, end, angle));
    }
    return out;
}

/// Moves a point in free space along its normal, away from walls parallel to its measuring plane and from the upper
/// edges of others, where rays would hit them at distance 0.
Point PlaceFinder::lifted_off_walls(const Point& p, const Normal& n) const {
    double lift = 0;
    visit_walls(p, [&](const Wall& wall) {
        if (std::abs(dot(wall.n, n)) <= parallel_cosine && rises_above(wall, p, n)) return;
        if (std::abs(dot(wall.n, n)) > parallel_cosine) {
            lift = std::max(lift, slack * step_ - dot(wall.n, p - wall.outline[0]) / dot(wall.n, n));
        } else {
            for (const Point& corner : wall.outline) lift = std::max(lift, slack * step_ + dot(n, corner - p));
        }
    });
    return p + lift * n;
}

Point PlaceFinder::middle(SurfaceId surface) const {
    return surface.is_none() ? centroid_ : centroid(scene_->regions()[scene_->surfaces()[surface].region].loops[0]);
}

MeasuredPlace PlaceFinder::find(const Point& p, const Normal& n, const Point* towards) const {
    const auto place_at = [&](const Point& x, SurfaceId s, bool is_between) {
        return MeasuredPlace{x, s, s.is_none() ? RegionId() : scene_->surfaces()[s].region, is_between};
    };
    const SurfaceId surface = locator_.find(p, n);
    const bool is_free = surface.is_none();
    const Normal& up = is_free ? n : scene_->surfaces()[surface].normal;
    const MeasuredPlace given = place_at(is_free ? lifted_off_walls(p, n) : p, surface, false);
    Point foot = given.x;
    if (!is_free) {
        const std::span<const Point> outline = scene_->outline(surface);
        foot -= dot(up, p - outline[0]) * up;
        if (!contains(outline, up, foot)) foot = nearest_on_border(outline, foot);
    }
    const std::vector<Blade> blades = blades_at(foot, up, given.region);
    if (blades.empty()) return given;

    std::vector<Sector> sectors = sectors_at(foot, up, blades);
    const auto lies_on = [&](const Sector& s) { return locator_.find(s.place, up); };
    if (!is_free)
        std::erase_if(sectors, [&](const Sector& s) {
            const SurfaceId there = lies_on(s);
            return there.is_none() || !contains(scene_->outline(there), up, s.place);
        });
    if (sectors.empty()) return given;
    const auto rank = [](const Sector& s) { return std::pair(s.backs, !s.holds_point); };
    const Sector* best = &*std::min_element(sectors.begin(), sectors.end(),
                                            [&](const Sector& a, const Sector& b) { return rank(a) < rank(b); });
    const auto equals = [&](const Sector& s) { return rank(s) == rank(*best); };
    const bool is_between =
        std::count_if(sectors.begin(), sectors.end(), [&](const Sector& s) { return s.backs == best->backs; }) > 1;
    if (std::count_if(sectors.begin(), sectors.end(), equals) > 1) {
        const Vec3 way = (towards ? *towards : middle(surface)) - foot;
        // The step is small compared with the distance, so that differences of less than a step are ignored.
        const auto is_better = [&](const Sector& a, const Sector& b) {
            const double gain = dot(way, a.inwards) - dot(way, b.inwards);
            if (std::abs(gain) > step_) return gain > 0;
            return a.front == b.front ? a.is_before_pane && !b.is_before_pane : a.front < b.front;
        };
        for (const Sector& s : sectors)
            if (equals(s) && is_better(s, *best)) best = &s;
    }
    return place_at(best->place, is_free ? surface : lies_on(*best), is_between || best->is_reflex);
}

}  // namespace exitance

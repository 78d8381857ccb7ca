#include "exitance/mesh/contact_lines.hpp"

#include <algorithm>
#include <optional>

#include "exitance/base/limits.hpp"

namespace exitance {
namespace {

using Segment = ContactLines::Line;

bool hovers(double hp, double hq, double tolerance, double gap) {
    return std::min(hp, hq) >= -tolerance && std::max(hp, hq) <= gap;
}

/// Adds the part of an edge inside a plane that the edge as a whole leaves, e.g. of a box rotated by a tiny angle. The
/// discontinuity ends where this part ends. Steep edges meet the plane only in a point and are skipped.
void contact_of_tilted_edge(const Point& p, const Point& q, const Plane& plane, double tolerance,
                            std::vector<Segment>& out) {
    constexpr double max_sine = 0.01;  // derived from a part that is 2e-5 of the scene's size long at this slope
    const double hp = plane.signed_distance(p), rise = plane.signed_distance(q) - hp;
    if (std::abs(rise) > max_sine * norm(q - p) || rise == 0) return;
    const double at_low = (-tolerance - hp) / rise, at_high = (tolerance - hp) / rise;
    const double first = std::max(0.0, std::min(at_low, at_high)), last = std::min(1.0, std::max(at_low, at_high));
    if (first < last) out.push_back({p + first * (q - p), p + last * (q - p), 0});
}

/// Adds the line of an edge that is in a plane or above it by less than `gap`. In the latter case also adds a line on
/// each side, at a distance equal to the edge's height: the width of the strip in which light changes. There is no such
/// strip if `leads_away(height)`.
template <class LeadsAway>
void contacts_of_edge(const Point& p, const Point& q, const Plane& plane, double tolerance, double gap,
                      std::vector<Segment>& out, const LeadsAway& leads_away) {
    const double hp = plane.signed_distance(p), hq = plane.signed_distance(q);
    if (!hovers(hp, hq, tolerance, gap)) return;
    const double height = std::max({hp, hq, 0.0});
    out.push_back({p, q, height});
    if (height <= 10 * tolerance || leads_away(height)) return;
    const Vec3 across = (height / norm(q - p)) * cross(plane.n, q - p);
    out.push_back({p + across, q + across, height});
    out.push_back({p - across, q - across, height});
}

/// How far a planar outline extends perpendicular to a line in its plane, on each side of the line; metres.
struct Reach {
    double left = 0, right = 0;

    Reach(std::span<const Point> outline, const Segment& line, const Normal& n) {
        const Vec3 d = line.b - line.a, across = (1 / norm(d)) * cross(n, d);
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (const Point& corner : outline) {
            const double at = dot(across, corner - line.a);
            least = std::min(least, at), most = std::max(most, at);
        }
        left = most, right = -least;
    }
    double whole() const { return left + right; }
};

/// Removes lines that change the light too little to justify a split.
void leave_worthy(std::vector<Segment>& lines, std::span<const Point> outline, double before_cuts, const Normal& n,
                  double tolerance) {
    // Shares of the element's width across the line. Chosen: five times the first takes 39% more rays where faces are
    // close, and three times the second 52% more, both measured by `exitance solve gaps.obj --error 0.02`. Light at the
    // ends of slats 2 m long varies over 0.3% of their length.
    constexpr double min_side_share = 0.002, min_depth_share = 0.03;
    std::erase_if(lines, [&](const Segment& line) {
        if (line.height <= 10 * tolerance) return false;
        const Reach reach(outline, line, n);
        const double width = before_cuts * reach.whole(), area = width * width;
        const bool is_part = std::min(reach.left, reach.right) > min_side_share * width;
        const double highest = line.is_strip() ? ContactLines::height_of_gap(area) : ContactLines::height_of_jump(area);
        return !is_part || line.height > highest || (line.is_strip() && line.gap_depth < min_depth_share * width);
    });
}

/// Sorts the lines of strips behind all others: those of short mouths first, and those far from a mouth first.
void strips_last(std::vector<Segment>& lines) {
    const auto strips =
        std::stable_partition(lines.begin(), lines.end(), [](const Segment& line) { return !line.is_strip(); });
    // Mouths that differ by less than 1% in length count as equally long, so that rounding does not order them.
    const auto rank = [](const Segment& line) {
        constexpr double steps_per_octave = 64;
        return std::pair(std::round(steps_per_octave * std::log2(norm(line.b - line.a))), -line.from_mouth);
    };
    std::stable_sort(strips, lines.end(), [&](const Segment& x, const Segment& y) { return rank(x) < rank(y); });
}

/// True if a point is on a border of a region.
bool is_on_border(const Region& region, const Point& x, double tolerance) {
    for (const std::vector<Point>& loop : region.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point& a = loop[i];
            const Vec3 d = loop[(i + 1) % loop.size()] - a;
            const double at = std::clamp(dot(x - a, d) / squared_norm(d), 0.0, 1.0);
            if (norm(x - a - at * d) <= tolerance) return true;
        }
    return false;
}

/// Adds the edges of a face that are in a plane and at which the face's region crosses the plane: on the other side of
/// such an edge is a coplanar face, so that it is no border of the region. Of these two faces, the one in front of the
/// plane adds the edge.
void crossings_along_edges(std::span<const Point> outline, const Region& region, const Plane& plane, double tolerance,
                           std::vector<Segment>& out) {
    const std::size_t m = outline.size();
    double highest = 0;
    for (const Point& p : outline) highest = std::max(highest, plane.signed_distance(p));
    if (highest <= tolerance) return;
    for (std::size_t i = 0; i < m; ++i) {
        const Point &p = outline[i], &q = outline[(i + 1) % m];
        if (std::abs(plane.signed_distance(p)) > tolerance || std::abs(plane.signed_distance(q)) > tolerance) continue;
        if (!is_on_border(region, 0.5 * (p + q), tolerance)) out.push_back({p, q, 0});
    }
}

/// Adds the line in which a face crosses a plane; edges of the face just above the plane are excluded.
void crossing_of_face(std::span<const Point> outline, const Plane& plane, double tolerance, double gap,
                      std::vector<Segment>& out) {
    const std::size_t m = outline.size();
    std::vector<Point> crossings;
    for (std::size_t i = 0; i < m; ++i) {
        const Point &p = outline[i], &q = outline[(i + 1) % m];
        const double hp = plane.signed_distance(p), hq = plane.signed_distance(q);
        if (hovers(hp, hq, tolerance, gap)) continue;
        if (std::abs(hp) <= tolerance)
            crossings.push_back(p);
        else if (std::abs(hq) > tolerance && (hp > 0) != (hq > 0))
            crossings.push_back(p + (hp / (hp - hq)) * (q - p));
    }
    if (crossings.size() < 2) return;
    // Sort along the line. A concave face may cross the plane in several segments, which are merged here.
    const Vec3 direction = crossings[1] - crossings[0];
    std::sort(crossings.begin(), crossings.end(),
              [&](const Point& a, const Point& b) { return dot(a, direction) < dot(b, direction); });
    out.push_back({crossings.front(), crossings.back(), 0});
}

/// Clips a segment to a convex polygon. Returns false if nothing is left.
bool clip_to_domain(const std::vector<Vec2>& domain, Vec2& a, Vec2& b) {
    double first = 0, last = 1;
    const Vec2 d = b - a;
    for (std::size_t i = 0; i < domain.size(); ++i) {
        const Vec2 p = domain[i], edge = domain[(i + 1) % domain.size()] - p;
        const double at_a = cross(edge, a - p), rate = cross(edge, d);  // inside where at_a + t rate >= 0
        if (std::abs(rate) < rounded_sine) {
            if (at_a < 0) return false;
            continue;
        }
        const double t = -at_a / rate;
        if (rate > 0)
            first = std::max(first, t);
        else
            last = std::min(last, t);
    }
    if (first >= last) return false;
    const Vec2 start = a;
    a = start + first * d;
    b = start + last * d;
    return true;
}

/// Part of a line inside an element, in its coordinates.
std::optional<std::pair<Vec2, Vec2>> part_inside(const ElementTree& tree, ElementId e, const Point& p, const Point& q) {
    Vec2 a = tree.patch(e).coordinates(p), b = tree.patch(e).coordinates(q);
    if (!clip_to_domain(tree.domain(e), a, b)) return {};
    return std::pair(a, b);
}

/// True if a contact in a single point, which separates nothing, remains of a line.
bool is_point(const std::pair<Vec2, Vec2>& line) {
    // Share of the element's size. Chosen: half of it and twice it give the same light, measured by `exitance solve
    // gaps.obj --error 0.02`.
    constexpr double min_length = 1e-3;
    return !(length(line.second - line.first) > min_length);
}

/// True if an edge begins at a corner of the element's own region and leads away from the element: an edge of the next
/// faces of a curved surface, on which no light changes here. `height`: of the edge above the element, metres.
bool leads_away(const ElementTree& tree, ElementId e, const Region& region, const Point& p, const Point& q,
                double height) {
    constexpr double near = 0.1;  // share of the height; derived from nearly coplanar faces (corners move much less)

    const auto is_corner = [&](const Point& x) {
        if (std::abs(region.plane.signed_distance(x)) > near * height) return false;
        return std::any_of(region.loops.begin(), region.loops.end(), [&](const std::vector<Point>& loop) {
            return std::any_of(loop.begin(), loop.end(),
                               [&](const Point& corner) { return norm(corner - x) <= near * height; });
        });
    };
    if (!is_corner(p) && !is_corner(q)) return false;
    const std::optional<std::pair<Vec2, Vec2>> part = part_inside(tree, e, p, q);
    return !part || is_point(*part);
}

}  // namespace

ContactLines::ContactLines(const Scene& scene) : scene_(&scene), tolerance_(contact_share * scene.size()) {
    std::vector<Box> boxes(scene.surfaces().size());
    for (SurfaceId s : scene.surfaces().ids())
        for (const Point& corner : scene.outline(s)) boxes[s.value].add(corner);
    faces_ = Bvh(boxes);
    std::size_t edges = 0;
    for (const Region& region : scene.regions())
        for (const std::vector<Point>& loop : region.loops) edges += loop.size();
    edges_.reserve(edges);
    // Edges between coplanar faces occlude nothing, so only borders of regions count.
    boxes.clear();
    const auto add_loop = [&](const std::vector<Point>& loop, RegionId r) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Edge& e = edges_.emplace_back(Edge{loop[i], loop[(i + 1) % loop.size()], r});
            boxes.emplace_back().add(e.a);
            boxes.back().add(e.b);
        }
    };
    for (RegionId r : scene.regions().ids())
        for (const std::vector<Point>& loop : scene.regions()[r].loops) add_loop(loop, r);
    for (const Pane& pane : scene.panes()) add_loop(pane.corners, RegionId());
    borders_ = Bvh(boxes);
    gap_lines_ = find_gap_lines(scene, faces_, 10 * tolerance_);
    boxes.clear();
    for (const GapLine& line : gap_lines_) boxes.emplace_back().add(line.a), boxes.back().add(line.b);
    gaps_ = Bvh(boxes);
}

std::vector<ContactLines::Line> ContactLines::around(const ElementTree& tree, ElementId e, double area) const {
    const RegionId own = tree.region(e);
    const Plane& plane = scene_->regions()[own].plane;
    const double gap = std::max(tolerance_, height_of_jump(area));
    Box box;
    for (const Point& corner : tree.outline(e)) {
        box.add(corner - tolerance_ * plane.n);
        box.add(corner + gap * plane.n);
    }
    box.lo -= Vec3{tolerance_, tolerance_, tolerance_};
    box.hi += Vec3{tolerance_, tolerance_, tolerance_};
    std::vector<Line> out;
    borders_.visit_box(box, [&](std::uint32_t i) {
        const Edge& edge = edges_[i];
        if (edge.region == own) return;
        contacts_of_edge(edge.a, edge.b, plane, tolerance_, gap, out, [&](double height) {
            return leads_away(tree, e, scene_->regions()[own], edge.a, edge.b, height);
        });
    });
    gaps_.visit_box(box, [&](std::uint32_t i) {
        const GapLine& line = gap_lines_[i];
        if (line.region == own && line.height <= height_of_gap(area))
            out.push_back({line.a, line.b, line.height, line.depth, line.from_mouth, line.inwards});
    });
    leave_worthy(out, tree.outline(e), std::sqrt(area / tree.area(e)), plane.n, tolerance_);
    faces_.visit_box(box, [&](std::uint32_t i) {
        const SurfaceId s(i);
        const RegionId region = scene_->surfaces()[s].region;
        if (region == own) return;
        crossing_of_face(scene_->outline(s), plane, tolerance_, gap, out);
        crossings_along_edges(scene_->outline(s), scene_->regions()[region], plane, tolerance_, out);
    });
    strips_last(out);
    return out;
}

std::vector<std::pair<Vec2, Vec2>> ContactLines::inside(const ElementTree& tree, ElementId e,
                                                        std::vector<Line>& lines) const {
    const std::vector<Point> outline = tree.outline(e);
    double longest = 0;
    for (const Point& corner : outline) longest = std::max(longest, norm(corner - outline[0]));
    // The slivers between contacts that differ by tiny angles are too thin to be split accurately.
    constexpr double min_width_in_tolerances = 100;  // multiple of the tolerance: 1e-5 of the scene's size
    if (tree.area(e) <= min_width_in_tolerances * tolerance_ * longest) lines.clear();
    std::vector<std::pair<Vec2, Vec2>> out;
    std::erase_if(lines, [&](const Line& line) {
        const std::optional<std::pair<Vec2, Vec2>> part = part_inside(tree, e, line.a, line.b);
        if (!part || is_point(*part)) return true;
        out.push_back(*part);
        return false;
    });
    return out;
}

std::vector<std::pair<Point, Point>> ContactLines::of_region(RegionId region) const {
    std::vector<std::pair<Point, Point>> out;
    for (const Line& line : over_plane({&region, 1}, 0)) out.emplace_back(line.a, line.b);
    return out;
}

std::vector<ContactLines::Line> ContactLines::over_plane(std::span<const RegionId> regions, double gap) const {
    const Plane& plane = scene_->regions()[regions.front()].plane;
    const auto is_of_others = [&](RegionId r) {
        return !std::binary_search(regions.begin(), regions.end(), r,
                                   [](RegionId a, RegionId b) { return a.value < b.value; });
    };
    // A surface that covers a point may be above it by this much (Occluders::is_covered).
    const double near = coplanar_share * scene_->size(), highest = std::max(near, gap);
    Box box;
    for (RegionId region : regions)
        for (const std::vector<Point>& loop : scene_->regions()[region].loops)
            for (const Point& corner : loop) {
                box.add(corner - near * plane.n);
                box.add(corner + highest * plane.n);
            }
    box.lo -= Vec3{near, near, near};
    box.hi += Vec3{near, near, near};
    std::vector<Line> out;
    borders_.visit_box(box, [&](std::uint32_t i) {
        const auto& [a, b, region] = edges_[i];
        if (!is_of_others(region)) return;
        if (hovers(plane.signed_distance(a), plane.signed_distance(b), near, highest))
            contacts_of_edge(a, b, plane, near, highest, out, [](double) { return false; });
        else
            contact_of_tilted_edge(a, b, plane, near, out);
    });
    faces_.visit_box(box, [&](std::uint32_t i) {
        const SurfaceId s(i);
        const RegionId region = scene_->surfaces()[s].region;
        if (!is_of_others(region)) return;
        crossing_of_face(scene_->outline(s), plane, near, highest, out);
        crossings_along_edges(scene_->outline(s), scene_->regions()[region], plane, near, out);
    });
    return out;
}

}  // namespace exitance

#include "exitance/visibility/visible_from_many.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exitance/base/four.hpp"
#include "exitance/base/limits.hpp"

namespace exitance {
namespace {

/// Heights below this, times an edge's length and the square of `reach_`, count as zero. Derived from double precision:
/// nine roundings.
constexpr double rounding = 2e-15;
/// Roundings of the largest coordinate that may lie between edges on one line. Derived from the few roundings of each
/// of the transformations that make and place a model; scanned gaps are far wider.
constexpr double roundings_on_one_line = 64;
/// From a point: below this, the intersection of two such edges is lost in rounding. Derived from the root of double
/// precision, twice that.
constexpr double coincident_from_point = 3e-8;
constexpr std::size_t max_turning_faces = 64;

/// Returns whether the inner side of the line depends on the viewpoint.
bool runs_either_way(const SightTables::Line& line) {
    return line.outline == SightTables::Outline::between_two || line.outline == SightTables::Outline::of_a_turning_one;
}

constexpr auto bit = SeenEdges::bit;  // bit of a corner or edge of the source

}  // namespace

Vec3 VisibleFromMany::place(const Point& p) const {
    const Vec2 flat = frame_.flat(p);
    return {flat.x, flat.y, frame_.height(p)};
}

/// Coefficients of det(b - x, a - x, p - x) for x in the receiver's plane and b = a + d; it equals (d x a) . (p - x) +
/// x . (d x p).
VisibleFromMany::Affine VisibleFromMany::Axis::height(const Vec3& p) const {
    return {dot(moment, p), along.y * p.z - along.z * p.y - moment.x, along.z * p.x - along.x * p.z - moment.y};
}

VisibleFromMany::Signs VisibleFromMany::signs(const Affine& f, double none, double nil) const {
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t k = 0; k < receiver_u_.size(); ++k) {
        const double h = f.c + f.u * receiver_u_[k] + f.v * receiver_v_[k];
        lowest = std::min(lowest, h), highest = std::max(highest, h);
    }
    return {highest > none, lowest<-none, highest> nil || lowest < -nil};
}

/// Adds to the tables a height for each corner (or edge) of the source, at indices place, place + stride, ... `heights`
/// returns four at a time.
template <class Heights>
EXITANCE_INLINE VisibleFromMany::Signs VisibleFromMany::add_heights(std::size_t stride, std::size_t place, double none,
                                                                    double nil, const Heights& heights) {
    using namespace four;
    Signs out;
    const std::size_t corners = tables_.corners.size();
    for (std::size_t first = 0; first < corners; first += four::lanes) {
        Real c, u, v, lowest = Real{} + HUGE_VAL, highest = -lowest;
        heights(first, c, u, v);
        for (std::size_t k = 0; k < receiver_u_.size(); ++k) {
            const Real h = c + u * receiver_u_[k] + v * receiver_v_[k];
            lowest = min(lowest, h), highest = max(highest, h);
        }
        const std::size_t used = std::min(four::lanes, corners - first);
        const auto add = [&](std::uint32_t& all, int lanes) {
            const std::uint32_t found = static_cast<std::uint32_t>(lanes) & ((1u << used) - 1);
            all |= first < 32 ? found << first : found != 0 ? 1u << 31 : 0;
        };
        const Mask above = highest > none, below = lowest < -none, away = (highest > nil) | (lowest < -nil);
        add(out.above, bits(above)), add(out.below, bits(below)), add(out.away, bits(away));
        for (std::size_t k = 0; k < used; ++k) tables_.heights[place + (first + k) * stride] = {c[k], u[k], v[k]};
    }
    return out;
}

/// Determines when an edge is part of the silhouette, and which side is inside. Sets `turned` if its direction is from
/// b to a. Returns false if it is never part of the silhouette.
bool VisibleFromMany::find_outline(const ConvexBlocker::Edge& e, bool is_sheet, Line& line, bool& turned) const {
    const auto l = static_cast<std::size_t>(e.left), r = static_cast<std::size_t>(e.right);
    const Facing left = facing_[l], right = is_sheet ? Facing::back : facing_[r];
    turned = false;
    if (is_sheet) {
        turned = left == Facing::back;
        line.outline = left == Facing::turning ? SightTables::Outline::of_a_turning_one : SightTables::Outline::always;
        line.left = turning_[l];
        return true;
    }
    if (left != Facing::turning && right != Facing::turning) {
        turned = left == Facing::back;
        line.outline = SightTables::Outline::always;
        return left != right;
    }
    if (left == Facing::turning && right == Facing::turning) {
        line.outline = SightTables::Outline::between_two;
        line.left = turning_[l], line.right = turning_[r];
        return true;
    }
    const bool left_turns = left == Facing::turning;
    const Facing other = left_turns ? right : left;
    line.left = turning_[left_turns ? l : r];
    line.outline = other == Facing::front ? SightTables::Outline::behind_a_face : SightTables::Outline::before_a_face;
    turned = left_turns == (other == Facing::front);  // the inside is the side of the visible face
    return true;
}

/// Adds the planes of those faces of a blocker that are front-facing from some points only. Returns false for a sheet
/// that is edge-on to the whole receiver.
bool VisibleFromMany::add_faces(const ConvexBlocker& shape, SightTables::Blocker& blocker) {
    facing_.clear();
    turning_.assign(shape.faces.size(), 0);
    blocker.first_face = static_cast<std::uint32_t>(tables_.faces.size());
    const double none = rounding * reach_;
    for (std::size_t k = 0; k < shape.faces.size(); ++k) {
        const Plane& face = shape.faces[k];
        const Affine height = {face.signed_distance(frame_.origin), dot(face.n, frame_.u), dot(face.n, frame_.v)};
        const auto [above, below, away] = signs(height, none, none);
        if (!shape.is_solid() && !above && !below) return false;
        facing_.push_back(!above ? Facing::back : !below ? Facing::front : Facing::turning);
        blocker.is_seen |= facing_.back() == Facing::front;
        if (facing_.back() != Facing::turning) continue;
        turning_[k] = static_cast<std::uint32_t>(tables_.faces.size());
        tables_.faces.push_back(height);
    }
    blocker.last_face = static_cast<std::uint32_t>(tables_.faces.size());
    return true;
}

/// Adds an edge of a silhouette, unless it never crosses the source. Returns whether the whole source is always outside
/// it.
bool VisibleFromMany::add_line(Line line, const ConvexBlocker::Edge& e, bool turned, std::uint32_t edge) {
    const std::size_t corners = tables_.corners.size();
    const std::uint32_t from = turned ? e.b : e.a, to = turned ? e.a : e.b;
    const Vec3 &a = points_[from], &b = points_[to];
    line.a = a, line.along = b - a;
    const double scale = norm(line.along) * reach_ * reach_;
    line.none = rounding * scale, line.tie = std::max(coincident_from_point, 8 * one_line_) * scale;
    line.over = static_cast<std::uint32_t>(tables_.heights.size());
    const auto column = [&](std::size_t i, std::size_t k) { return four::load(&source_columns_[i][k]); };
    const Axis axis(a, line.along);
    const Vec3 &d = axis.along, &m = axis.moment;
    tables_.heights.resize(line.over + corners);
    const Signs over = add_heights(1, line.over, line.none, one_line_ * scale,
                                   [&](std::size_t k, four::Real& c, four::Real& u, four::Real& v) {
                                       const four::Real x = column(0, k), y = column(1, k), z = column(2, k);
                                       c = m.x * x + m.y * y + m.z * z;
                                       u = d.y * z - d.z * y - m.x, v = d.z * x - d.x * z - m.y;
                                   });
    const std::uint32_t all = corners < 32 ? (1u << corners) - 1 : ~0u;
    const bool all_out = over.above == 0;
    line.cuts = runs_either_way(line) ? all : over.below;
    if (line.cuts == 0) {
        tables_.heights.resize(line.over);
        return all_out;
    }
    // Edges of the source that are on the line from everywhere. A single corner on it keeps its height: rounding it
    // alone to zero could hide that its edge crosses the line.
    std::uint32_t on_line = 0;
    const std::uint32_t nil = all & ~over.away;
    for (std::size_t s = 0; nil != 0 && s < corners; ++s) {
        const std::size_t next = s + 1 == corners ? 0 : s + 1;
        if ((nil & bit(s)) == 0 || (nil & bit(next)) == 0) continue;
        on_line |= bit(s);
        tables_.heights[line.over + s] = tables_.heights[line.over + next] = {};
    }
    tables_.heights.resize(line.over + 3 * corners);
    Signs of_ends[2];
    for (std::size_t end : {0, 1}) {
        const Vec3& p = end == 0 ? a : b;
        of_ends[end] = add_heights(2, line.over + corners + end, 0, 0,
                                   [&](std::size_t k, four::Real& c, four::Real& u, four::Real& v) {
                                       const four::Real x = column(3, k), y = column(4, k), z = column(5, k);
                                       const four::Real mx = column(6, k), my = column(7, k), mz = column(8, k);
                                       c = mx * p.x + my * p.y + mz * p.z;
                                       u = y * p.z - z * p.y - mx, v = z * p.x - x * p.z - my;
                                   });
    }
    line.cut_by = of_ends[0].below | of_ends[1].below;
    std::uint32_t* const of_corner = &corners_crossed_[corners_crossed_.size() - points_.size()];
    of_corner[from] |= of_ends[0].above & of_ends[0].below;
    of_corner[to] |= of_ends[1].above & of_ends[1].below;
    // The edge is not drawn if it is outside, or coincides with an edge of the source, which is counted instead.
    line.is_drawn = (of_ends[0].above | of_ends[1].above) == all && on_line == 0;
    tables_.lines.push_back(line);
    edges_.push_back(edge), crossed_.push_back(over.above & over.below);
    return all_out;
}

/// Adds the lines of a blocker that may cross the source.
VisibleFromMany::Kept VisibleFromMany::add_blocker(const ConvexBlocker& shape) {
    SightTables::Blocker blocker;
    const std::size_t mark = tables_.heights.size();
    blocker.first = static_cast<std::uint32_t>(tables_.lines.size());
    if (!add_faces(shape, blocker)) return Kept::nothing;
    blocker.may_hold = shape.is_solid() && !blocker.is_seen;
    points_.clear();
    for (const Point& p : shape.points) points_.push_back(place(p));
    corners_crossed_.resize(corners_crossed_.size() + points_.size(), 0);
    bool is_beside = false;
    for (std::uint32_t k = 0; k < shape.edges.size() && !is_beside; ++k) {
        const ConvexBlocker::Edge& e = shape.edges[k];
        Line line;
        bool turned = false;
        if (!find_outline(e, !shape.is_solid(), line, turned)) continue;
        const bool all_out = add_line(line, e, turned, k);
        is_beside = all_out && line.outline == SightTables::Outline::always && !blocker.may_hold;
    }
    blocker.last = static_cast<std::uint32_t>(tables_.lines.size());
    if (is_beside || blocker.last == blocker.first) {
        tables_.lines.resize(blocker.first), edges_.resize(blocker.first), crossed_.resize(blocker.first);
        tables_.heights.resize(mark), corners_crossed_.resize(corners_crossed_.size() - points_.size());
        tables_.faces.resize(blocker.first_face);
        return is_beside ? Kept::nothing : Kept::hides_all;
    }
    is_crowded_ |= blocker.last - blocker.first > SightTables::max_lines;
    tables_.blockers.push_back(blocker);
    seen_edges_.push_back({&shape, {}, {}, {}});
    return Kept::some;
}

/// Adds the heights of the ends of blocker k's lines over the lines of blocker j.
void VisibleFromMany::join(std::size_t k, std::size_t j) {
    const SightTables::Blocker &mine = tables_.blockers[k], &other = tables_.blockers[j];
    tables_.between[k * SightTables::max_blockers + j] = static_cast<std::uint32_t>(tables_.heights.size());
    for (std::uint32_t i = mine.first; i < mine.last; ++i)
        for (std::uint32_t l = other.first; l < other.last; ++l) {
            const Line &e = tables_.lines[i], &f = tables_.lines[l];
            const Axis axis(f.a, f.along);
            Affine of_a = axis.height(e.a), of_b = axis.height(e.a + e.along);
            const double nil = one_line_ * norm(f.along) * reach_ * reach_;
            if (!signs(of_a, nil, nil).away && !signs(of_b, nil, nil).away)
                of_a.u = SightTables::on_one_line, of_a.c = dot(e.along, f.along);
            tables_.heights.push_back(of_a), tables_.heights.push_back(of_b);
        }
}

void VisibleFromMany::set_source(std::span<const Point> source) {
    tables_.corners.clear(), tables_.along.clear();
    for (const Point& p : source) tables_.corners.push_back(place(p));
    const std::size_t count = source.size();
    for (auto& column : source_columns_) column.resize((count + four::lanes - 1) / four::lanes * four::lanes);
    for (std::size_t s = 0; s < count; ++s) {
        const Vec3& p = tables_.corners[s];
        const Axis axis(p, tables_.corners[s + 1 == count ? 0 : s + 1] - p);
        tables_.along.push_back(axis.along);
        for (std::size_t i = 0; i < 3; ++i) {
            source_columns_[i][s] = p[i];
            source_columns_[3 + i][s] = axis.along[i], source_columns_[6 + i][s] = axis.moment[i];
        }
    }
}

VisibleFromMany::Outlook VisibleFromMany::set(const PlaneFrame& frame, std::span<const Vec2> receiver,
                                              std::span<const Point> source,
                                              std::span<const ConvexBlocker* const> blockers) {
    frame_ = frame, source_ = source, blockers_ = blockers;
    single_is_set_ = false;
    tables_.blockers.clear(), tables_.lines.clear();
    tables_.faces.clear(), tables_.heights.clear(), edges_.clear(), seen_edges_.clear();
    crossed_.clear(), corners_crossed_.clear();
    Box box;
    receiver_u_.clear(), receiver_v_.clear();
    for (Vec2 x : receiver) box.add(Point{x.x, x.y, 0}), receiver_u_.push_back(x.x), receiver_v_.push_back(x.y);
    set_source(source);
    for (const Vec3& p : tables_.corners) box.add(p);
    reach_ = box.diagonal();
    double largest = 0;
    for (const Point& p : source) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    one_line_ = std::max(zero_sine, roundings_on_one_line * std::numeric_limits<double>::epsilon() * largest /
                                        std::max(reach_, min_divisor));
    is_crowded_ = source.size() > SightTables::max_corners;
    for (const ConvexBlocker* shape : blockers)
        if (add_blocker(*shape) == Kept::hides_all) return Outlook::hidden;
    if (tables_.blockers.empty()) return Outlook::clear;
    std::size_t corners = 0;
    for (std::size_t k = 0; k < seen_edges_.size(); ++k) {
        const SightTables::Blocker& b = tables_.blockers[k];
        SeenEdges& seen = seen_edges_[k];
        seen.edges = std::span(edges_).subspan(b.first, b.last - b.first);
        seen.edges_over_corners = std::span(crossed_).subspan(b.first, b.last - b.first);
        seen.corners_over_edges = std::span(corners_crossed_).subspan(corners, seen.body->points.size());
        corners += seen.body->points.size();
    }
    is_crowded_ |= tables_.blockers.size() > SightTables::max_blockers || tables_.faces.size() > max_turning_faces;
    for (std::size_t k = 0; !is_crowded_ && k < tables_.blockers.size(); ++k)
        for (std::size_t j = 0; j < tables_.blockers.size(); ++j)
            if (j != k) join(k, j);
    return Outlook::partly;
}

/// Evaluates up to four points by clipping the source.
void VisibleFromMany::look_otherwise(std::span<const Vec2> points, std::span<double> F, std::span<Seen> seen) {
    std::array<Point, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = frame_.at(points[std::min(i, points.size() - 1)]);
    std::array<double, 4> of_four;
    Seen alike;
    if (points.size() > 1 && from_four_(source_, blockers_, x, frame_.n, of_four, alike)) {
        std::copy_n(of_four.begin(), points.size(), F.begin());
        std::fill(seen.begin(), seen.end(), alike);
        return;
    }
    if (!single_is_set_) single_.set(source_, blockers_);
    single_is_set_ = true;
    for (std::size_t i = 0; i < points.size(); ++i) F[i] = single_(x[i], frame_.n, seen[i]);
}

void VisibleFromMany::operator()(std::span<const Vec2> points, std::span<const std::size_t> ends, std::span<double> F,
                                 std::span<Seen> seen) {
    if (is_crowded_) {
        std::size_t first = 0;
        for (std::size_t end : ends)
            for (; first < end; first = std::min(first + four::lanes, end)) {
                const std::size_t used = std::min(four::lanes, end - first);
                look_otherwise(points.subspan(first, used), F.subspan(first, used), seen.subspan(first, used));
            }
        return;
    }
    constexpr std::size_t lanes = SightTables::lanes;
    for (std::size_t first = 0; first < points.size(); first += lanes) {
        const std::size_t last = std::min(first + lanes, points.size());
        std::array<double, lanes> u, v;
        for (std::size_t i = 0; i < lanes; ++i) {
            const Vec2 p = points[std::min(first + i, last - 1)];
            u[i] = p.x, v[i] = p.y;
        }
        const Views views = look_from_points(tables_, u.data(), v.data(), last - first);
        for (std::size_t i = first; i < last; ++i) {
            const int bit = 1 << (i - first);
            F[i] = views.F[i - first];
            seen[i] = views.dark & bit  ? Seen::nothing
                      : views.lit & bit ? Seen::all
                      : F[i] == 0       ? Seen::nothing_past_several
                                        : Seen::part;
            if (views.doubtful & bit) look_otherwise(points.subspan(i, 1), F.subspan(i, 1), seen.subspan(i, 1));
        }
    }
}

double VisibleFromMany::unoccluded(Vec2 p) {
    terms_.clear();
    for (std::size_t s = 0; s < tables_.corners.size(); ++s) {
        const Vec3 x = {p.x, p.y, 0}, a = tables_.corners[s] - x;
        terms_.add({0, 0, 1}, a, a + tables_.along[s], 1);
    }
    return std::max(0.0, terms_.sum());
}

}  // namespace exitance

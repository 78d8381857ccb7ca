#include "exitance/transport/visible_from_many.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

constexpr double rounding = 2e-15;  ///< Of an edge's length times the square of all lengths' bound: a height of none.
constexpr double one_line = 1e-12;  ///< Edges that fall together from everywhere.
constexpr double fall_together = 3e-8;  ///< From a point: where such edges meet is lost in rounding.
constexpr std::size_t most_turning = 64;

/// Is its inner side one or the other, by where it is seen from?
bool runs_either_way(const SightTables::Line& line) {
    return line.outline == SightTables::Outline::between_two || line.outline == SightTables::Outline::of_a_turning_one;
}

}  // namespace

Vec3 VisibleFromMany::place(const Point& p) const {
    const Vec2 flat = frame_.flat(p);
    return {flat.x, flat.y, frame_.height(p)};
}

/// det(b - x, a - x, p - x) for x in the receiver's plane.
VisibleFromMany::Affine VisibleFromMany::determinant(const Vec3& a, const Vec3& b, const Vec3& p) const {
    const Vec3 n = cross(b - p, a - p);
    return {dot(n, p), -n.x, -n.y};
}

/// Least and largest value on the receiver.
void VisibleFromMany::bound(const Affine& f, double& low, double& high) const {
    low = HUGE_VAL, high = -HUGE_VAL;
    for (Vec2 x : receiver_) {
        const double value = f.c + f.u * x.x + f.v * x.y;
        low = std::min(low, value), high = std::max(high, value);
    }
}

/// When is an edge of the silhouette, and which side is inside? `turned` when it runs from b to a. False when it never
/// is one.
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
    turned = left_turns == (other == Facing::front);  // inside is the side of the face that is seen
    return true;
}

/// Adds the lines of a blocker that may cross the source.
VisibleFromMany::Kept VisibleFromMany::add_blocker(const ConvexBlocker& shape) {
    SightTables::Blocker blocker;
    const bool is_sheet = !shape.is_solid();
    points_.clear();
    for (const Point& p : shape.points) points_.push_back(place(p));
    facing_.clear();
    turning_.assign(shape.faces.size(), 0);
    blocker.first_face = static_cast<std::uint32_t>(tables_.faces.size());
    for (std::size_t k = 0; k < shape.faces.size(); ++k) {
        const Plane& face = shape.faces[k];
        const Affine height = {face.signed_distance(frame_.origin), dot(face.n, frame_.u), dot(face.n, frame_.v)};
        double low, high;
        bound(height, low, high);
        const double none = rounding * reach_;
        const bool edge_on = high <= none && low >= -none;
        if (edge_on && is_sheet) return Kept::nothing;
        facing_.push_back(high <= none ? Facing::back : low >= -none ? Facing::front : Facing::turning);
        blocker.is_seen |= facing_.back() == Facing::front;
        if (facing_.back() != Facing::turning) continue;
        turning_[k] = static_cast<std::uint32_t>(tables_.faces.size());
        tables_.faces.push_back(height);
    }
    blocker.last_face = static_cast<std::uint32_t>(tables_.faces.size());
    blocker.may_hold = !is_sheet && !blocker.is_seen;
    blocker.first = static_cast<std::uint32_t>(tables_.lines.size());
    const std::size_t corners = tables_.corners.size(), mark = tables_.heights.size();
    const auto drop = [&] {
        tables_.lines.resize(blocker.first), edges_.resize(blocker.first), tables_.heights.resize(mark);
        tables_.faces.resize(blocker.first_face);
    };
    for (std::uint32_t k = 0; k < shape.edges.size(); ++k) {
        const ConvexBlocker::Edge& e = shape.edges[k];
        Line line;
        bool turned = false;
        if (!find_outline(e, is_sheet, line, turned)) continue;
        const Vec3 a = points_[turned ? e.b : e.a], b = points_[turned ? e.a : e.b];
        line.a = a, line.along = b - a;
        const double scale = norm(line.along) * reach_ * reach_;
        line.none = rounding * scale, line.tie = fall_together * scale;
        line.over = static_cast<std::uint32_t>(tables_.heights.size());
        bool crosses = runs_either_way(line), all_out = true, lies_on_one = false, before_was_nil = false,
             first_is_nil = false;
        for (std::size_t s = 0; s < corners; ++s) {
            Affine height = determinant(a, b, tables_.corners[s]);
            double low, high;
            bound(height, low, high);
            crosses |= low < -line.none, all_out &= high <= line.none;
            const bool nil = std::max(high, -low) <= one_line * scale;
            lies_on_one |= nil && before_was_nil;
            if (s == 0) first_is_nil = nil;
            before_was_nil = nil;
            if (nil) height = {};
            tables_.heights.push_back(height);
        }
        lies_on_one |= before_was_nil && first_is_nil;
        if (all_out && line.outline == SightTables::Outline::always && !blocker.may_hold) return drop(), Kept::nothing;
        if (!crosses) {
            tables_.heights.resize(line.over);
            continue;
        }
        line.is_drawn = !lies_on_one;
        for (std::size_t s = 0; s < corners; ++s) {
            const Vec3 &p = tables_.corners[s], q = tables_.corners[s + 1 == corners ? 0 : s + 1];
            const Affine of_a = determinant(p, q, a), of_b = determinant(p, q, b);
            tables_.heights.push_back(of_a), tables_.heights.push_back(of_b);
            double low_a, high_a, low_b, high_b;
            bound(of_a, low_a, high_a), bound(of_b, low_b, high_b);
            if (high_a <= 0 && high_b <= 0) line.is_drawn = false;
        }
        tables_.lines.push_back(line);
        edges_.push_back(k);
    }
    blocker.last = static_cast<std::uint32_t>(tables_.lines.size());
    if (blocker.last == blocker.first) return drop(), Kept::hides_all;
    is_crowded_ |= blocker.last - blocker.first > SightTables::most_lines;
    tables_.blockers.push_back(blocker);
    seen_edges_.push_back({&shape, {}});
    return Kept::some;
}

/// Heights of the ends of one blocker's lines over the other's.
void VisibleFromMany::join(std::size_t k, std::size_t j) {
    const SightTables::Blocker &mine = tables_.blockers[k], &other = tables_.blockers[j];
    tables_.between[k * SightTables::most_blockers + j] = static_cast<std::uint32_t>(tables_.heights.size());
    for (std::uint32_t i = mine.first; i < mine.last; ++i)
        for (std::uint32_t l = other.first; l < other.last; ++l) {
            const Line &e = tables_.lines[i], &f = tables_.lines[l];
            Affine of_a = determinant(f.a, f.a + f.along, e.a), of_b = determinant(f.a, f.a + f.along, e.a + e.along);
            double low_a, high_a, low_b, high_b;
            bound(of_a, low_a, high_a), bound(of_b, low_b, high_b);
            if (std::max({high_a, high_b, -low_a, -low_b}) <= one_line * norm(f.along) * reach_ * reach_)
                of_a.u = SightTables::on_one_line, of_a.c = dot(e.along, f.along);
            tables_.heights.push_back(of_a), tables_.heights.push_back(of_b);
        }
}

VisibleFromMany::Outlook VisibleFromMany::set(const PlaneFrame& frame, std::span<const Vec2> receiver,
                                              std::span<const Point> source,
                                              std::span<const ConvexBlocker* const> blockers) {
    frame_ = frame, receiver_ = receiver, source_ = source, blockers_ = blockers;
    single_is_set_ = false;
    tables_.corners.clear(), tables_.along.clear(), tables_.blockers.clear(), tables_.lines.clear();
    tables_.faces.clear(), tables_.heights.clear(), edges_.clear(), seen_edges_.clear();
    Box box;
    for (Vec2 x : receiver) box.add(Point{x.x, x.y, 0});
    for (const Point& p : source) tables_.corners.push_back(place(p)), box.add(tables_.corners.back());
    for (std::size_t s = 0; s < source.size(); ++s)
        tables_.along.push_back(tables_.corners[s + 1 == source.size() ? 0 : s + 1] - tables_.corners[s]);
    reach_ = box.diagonal();
    is_crowded_ = source.size() > SightTables::most_corners;
    for (const ConvexBlocker* shape : blockers)
        if (add_blocker(*shape) == Kept::hides_all) return Outlook::hidden;
    if (tables_.blockers.empty()) return Outlook::clear;
    for (std::size_t k = 0; k < seen_edges_.size(); ++k) {
        const SightTables::Blocker& b = tables_.blockers[k];
        seen_edges_[k].edges = std::span(edges_).subspan(b.first, b.last - b.first);
    }
    is_crowded_ |= tables_.blockers.size() > SightTables::most_blockers || tables_.faces.size() > most_turning;
    for (std::size_t k = 0; !is_crowded_ && k < tables_.blockers.size(); ++k)
        for (std::size_t j = 0; j < tables_.blockers.size(); ++j)
            if (j != k) join(k, j);
    return Outlook::partly;
}

/// Up to four points, by cutting.
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
    constexpr std::size_t lanes = SightTables::lanes;
    if (is_crowded_) {
        std::size_t first = 0;
        for (std::size_t end : ends)
            for (; first < end; first = std::min(first + lanes, end)) {
                const std::size_t used = std::min(lanes, end - first);
                look_otherwise(points.subspan(first, used), F.subspan(first, used), seen.subspan(first, used));
            }
        return;
    }
    for (std::size_t first = 0; first < points.size(); first += lanes) {
        const std::size_t last = std::min(first + lanes, points.size());
        std::array<double, lanes> u, v;
        for (std::size_t i = 0; i < lanes; ++i) {
            const Vec2 p = points[std::min(first + i, last - 1)];
            u[i] = p.x, v[i] = p.y;
        }
        FourViews views;
        look_from_four(tables_, u.data(), v.data(), views);
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

#include "exitance/transport/occluded_pair.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/transport/pair_form_factor.hpp"

namespace exitance {
namespace {

constexpr int deepest = 20;                ///< Halvings of a cell: what is left is 1e-3 of its size in each direction.
constexpr double dominating = 0.03;        ///< An entry above it makes its row's error.
constexpr double dominating_share = 0.25;  ///< Of the tolerance, for such an entry.
constexpr double near_share = 0.5;  ///< Of the difference of two rules that the better one may leave, at an edge.

double cross_area(std::span<const Vec2> corners) {
    double twice = 0;
    for (std::size_t i = 2; i < corners.size(); ++i)
        twice += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return 0.5 * twice;
}

Vec2 middle_of(std::span<const Vec2> corners) {
    Vec2 sum{};
    for (Vec2 p : corners) sum = sum + p;
    return (1.0 / static_cast<double>(corners.size())) * sum;
}

double diameter(std::span<const Vec2> corners) {
    double squared = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            squared = std::max(squared, dot(corners[i] - corners[j], corners[i] - corners[j]));
    return std::sqrt(squared);
}

double squared_distance(const Point& x, const Point& a, const Point& b) {
    const Vec3 e = b - a, d = x - a;
    const double length = dot(e, e), t = length > 0 ? std::clamp(dot(d, e) / length, 0.0, 1.0) : 0;
    return dot(d - t * e, d - t * e);
}

/// From a point to a convex polygon with normal n, metres.
double distance(const Point& x, std::span<const Point> polygon, const Normal& n) {
    double nearest = HUGE_VAL;
    bool above = true;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        above &= dot(cross(b - a, x - a), n) >= 0;
        nearest = std::min(nearest, squared_distance(x, a, b));
    }
    return above ? std::abs(dot(n, x - polygon[0])) : std::sqrt(nearest);
}

}  // namespace

double OccludedExchange::seen_from(Vec2 p, Seen& seen) {
    ++evaluations;
    return visible_(frame_.at(p), frame_.n, seen);
}

/// Looks at a cell with two Gauss points a side.
void OccludedExchange::look(Cell& cell) {
    cell.area = std::max(0.0, cross_area(cell.corners()));
    cell.glance = {};
    cell.two_points = apply(cell, 2, cell.glance);
}

/// The rule's sum of visible form factors: four points at a time while they see alike.
double OccludedExchange::apply(const Cell& cell, int points, Glance& glance) {
    place_nodes(cell, points);
    evaluations += nodes_.size();
    double sum = 0;
    const auto take = [&](double weight, double F, Seen seen) {
        sum += weight * F;
        ++glance.count, glance.dark += seen == Seen::nothing, glance.lit += seen == Seen::all;
        glance.black += seen <= Seen::nothing_past_several;
        glance.lowest = std::min(glance.lowest, F), glance.highest = std::max(glance.highest, F);
    };
    for (std::size_t first = 0; first < nodes_.size(); first += 4) {
        const std::size_t used = std::min<std::size_t>(4, nodes_.size() - first);
        std::array<Point, 4> x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = nodes_[first + std::min(i, used - 1)].at;
        std::array<double, 4> F;
        Seen seen;
        if (used > 1 && visible_from_four_(pair_.source, pair_.blockers, x, frame_.n, F, seen)) {
            for (std::size_t i = 0; i < used; ++i) take(nodes_[first + i].weight, F[i], seen);
            continue;
        }
        for (std::size_t i = 0; i < used; ++i) {
            const double alone = visible_(x[i], frame_.n, seen);
            take(nodes_[first + i].weight, alone, seen);
        }
    }
    return sum;
}

double OccludedExchange::integrate_halves(const Cell& cell, double allowed, int depth) {
    // Across the longest edge, and for a quadrilateral across the edge opposite to it.
    std::size_t longest = 0;
    double most = 0;
    for (std::size_t i = 0; i < cell.count; ++i) {
        const Vec2 e = cell.corner[(i + 1) % cell.count] - cell.corner[i];
        if (dot(e, e) > most) most = dot(e, e), longest = i;
    }
    const auto at = [&](std::size_t i) { return cell.corner[(longest + i) % cell.count]; };
    const Vec2 p = 0.5 * (at(0) + at(1));
    Cell one, two;
    if (cell.count == 3) {
        one.add(p), one.add(at(1)), one.add(at(2));
        two.add(p), two.add(at(2)), two.add(at(0));
    } else {
        const Vec2 q = 0.5 * (at(2) + at(3));
        one.add(p), one.add(at(1)), one.add(at(2)), one.add(q);
        two.add(p), two.add(q), two.add(at(3)), two.add(at(0));
    }
    look(one), look(two);
    return integrate(one, distance_to_source(one), 0.5 * allowed, depth + 1) +
           integrate(two, distance_to_source(two), 0.5 * allowed, depth + 1);
}

/// A lower bound: boxes of slanting faces reach far beyond them, so that the source is asked itself.
double OccludedExchange::distance_to_source(const Cell& cell) const {
    const Vec2 middle = middle_of(cell.corners());
    double radius = 0, height = HUGE_VAL;
    for (Vec2 p : cell.corners()) {
        radius = std::max(radius, dot(p - middle, p - middle));
        height = std::min(height, pair_.source_plane.signed_distance(frame_.at(p)));
    }
    const double apart = distance(frame_.at(middle), pair_.source, pair_.source_plane.n) - std::sqrt(radius);
    return std::max({apart, height, 0.0});
}

/// No point of a cell d from the source has a larger form factor than this.
double OccludedExchange::brightest(double d) const {
    return source_area_ < pi * d * d ? source_area_ / (pi * d * d) : 1;
}

/// An integrand that is analytic but for a place at a distance of g cell sizes (here the source) leaves n Gauss points
/// a side an error like rho^(-2n), rho = 1 + 2g + 2 sqrt(g + g^2).
double OccludedExchange::convergence(const Cell& cell, double d) const {
    const double g = d / diameter(cell.corners());
    return 1 + 2 * g + 2 * std::sqrt(g + g * g);
}

/// A cell that sees all of the source: as many Gauss points as its distance asks for.
double OccludedExchange::integrate_smooth(const Cell& cell, double d, double allowed) {
    const double rho = convergence(cell, d);
    const double whole = cell.area * brightest(d);
    const double wanted = std::max(allowed, 1e-16 * whole);
    const double digits = whole > wanted ? std::log(whole / wanted) : 0;
    const int points = std::max(2, static_cast<int>(std::ceil(digits / (2 * std::log(std::max(rho, 1.0001))))));
    if (points == 2 && cell.count == 4) return cell.two_points;
    if (points > 8) {  // too near for Gauss points: the contour integral of the cell itself
        std::array<Point, 4> corners;
        for (std::size_t i = 0; i < cell.count; ++i) corners[i] = frame_.at(cell.corner[i]);
        return exchange_area(std::span(corners).first(cell.count), pair_.source,
                             std::clamp(allowed / whole, 1e-12, 1e-3));
    }
    place_nodes(cell, points);
    double sum = 0;
    for (const Node& node : nodes_) sum += node.weight * visible_.unoccluded(node.at, frame_.n);
    return sum;
}

/// Does a blocker's edge pass over the cell within its size? What is seen changes within the edge's height over the
/// receiver then, perhaps between the points of a rule, which agree with each other and are wrong.
bool OccludedExchange::is_under_an_edge(const Cell& cell) const {
    const Vec2 flat = middle_of(cell.corners());
    const Point middle = frame_.at(flat);
    double squared = 0;
    for (Vec2 p : cell.corners()) squared = std::max(squared, dot(p - flat, p - flat));
    const double slack = nearest_line * size_;
    for (const ConvexBlocker* blocker : pair_.blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point &a = blocker->points[e.a], &b = blocker->points[e.b];
            if (frame_.height(a) <= slack && frame_.height(b) <= slack) continue;
            if (squared_distance(middle, a, b) < 1.5 * squared) return true;
        }
    return false;
}

/// A rising row of rules until two agree, else halves. The difference of two rules is the error of the lesser one; the
/// better one's is a small share of it, but no less than the source's distance lets expect. Two points a side need a
/// second witness, as bends of opposite sign cancel in their difference from the middle: exp(a s) on [-1, 1] errs by
/// a^4 / 270 and varies by a / sqrt 3 at the points; where the entry is among its row's large ones, every bend counts.
/// Shares are from cells of rooms with blocks: of a hundred cells accepted one errs by more than its allowance, none by
/// ten times that.
double OccludedExchange::integrate(const Cell& cell, double d, double allowed, int depth) {
    const bool fine = relative_ < 1e-5 || dominates_;
    const double rho = convergence(cell, d), step = 1 / (rho * rho);
    const double far = 2 * cell.area * brightest(d);
    const bool near = dominates_ && is_under_an_edge(cell);
    Glance glance = cell.glance;
    double before = cell.two_points;
    if (fine) {
        before = apply(cell, 3, glance);
    } else if (glance.black == 0 && !near) {
        Seen seen;
        const double middle = std::max(seen_from(middle_of(cell.corners()), seen), 1e-300);
        const double most = std::max(glance.highest / middle - 1, 1 - glance.lowest / middle), varies = 3 * most * most;
        const double witness = before * (varies * varies / 270 + (matters_ ? 0.005 * most : 0)) + far * step * step;
        const double part = cell.count == 3 ? 0.2 : 0.03;  // three points of a triangle are but of degree 2
        if (part * std::abs(before - cell.area * middle) + witness <= allowed) return before;
    }
    for (int points : fine ? std::array{5, 8} : std::array{3, 4}) {
        const double sum = apply(cell, points, glance);
        if (glance.black == glance.count) return 0;
        const double share = near ? near_share : fine || matters_ ? 0.1 : 0.03;
        if (share * std::abs(sum - before) + far * std::pow(step, points) <= allowed) return sum;
        before = sum;
        if (!fine) break;
    }
    if (depth >= deepest || evaluations > enough_) return before;
    return integrate_halves(cell, allowed, depth);
}

double OccludedExchange::operator()(const OccludedPair& pair, const Demand& demand, bool& unoccluded) {
    unoccluded = false;
    pair_ = pair;
    relative_ = demand.relative;
    visible_.set(pair.source, pair.blockers);
    if (visible_.is_hidden_from(pair.receiver)) return 0;

    frame_ = PlaneFrame(pair.receiver[0], pair.receiver_plane.n);
    Cell whole;
    for (const Point& p : pair.receiver) whole.add(frame_.flat(p));
    size_ = diameter(whole.corners());
    cells_.clear();
    cut_into_cells(whole, 0);

    bool all = true;
    double estimate = 0;
    for (Cell& cell : cells_) {
        look(cell);
        all &= cell.complete && cell.glance.lit == cell.glance.count;
        estimate += cell.two_points;
    }
    if (all) return unoccluded = true, 0;

    matters_ = estimate > demand.large;
    dominates_ = estimate > dominating * norm(area_vector(pair.receiver));
    const double allowed = std::max((dominates_ ? dominating_share : 1) * demand.relative * estimate, demand.absolute);
    source_area_ = norm(area_vector(pair.source));
    const double share = allowed / std::sqrt(static_cast<double>(cells_.size()));
    double total = 0;
    enough_ = evaluations;
    for (const Cell& cell : cells_) {
        // What a cell leaves of its ration goes to the cells after it, so that none starves another.
        enough_ += (relative_ < 1e-5 ? 1000 : 50) * (1 + 1000 / cells_.size());
        if (cell.complete && cell.glance.dark == cell.glance.count) continue;
        const double d = distance_to_source(cell);
        if (cell.complete && cell.glance.lit == cell.glance.count)
            total += integrate_smooth(cell, d, 0.3 * share);
        else if (cell.area * brightest(d) < 0.3 * share)
            total += cell.two_points;
        else
            total += integrate(cell, d, share, 0);
    }
    return total;
}

}  // namespace exitance

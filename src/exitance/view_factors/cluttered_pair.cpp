#include "exitance/view_factors/cluttered_pair.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/geometry/quadrature.hpp"

namespace exitance {
namespace {

constexpr std::size_t least_cells = 32;  ///< Of the receiver before differences are believed.
constexpr std::size_t most_parts = 48;   ///< Cut under edges.
constexpr double near_edge = 0.1;        ///< Of the receiver's size: the height of edges that it is cut under.
/// Of what a dark cell would hold at the slope at which light fades over the whole receiver: a corner that its points
/// missed.
constexpr double dark_corner = 0.1;
constexpr std::size_t halvings_a_look = 64;  ///< At the clock.
constexpr double unseen_brightness = 0.05;   ///< Of the whole source: what may have been missed where nothing was seen.

double squared_distance(const Point& x, const Point& a, const Point& b) {
    const Vec3 e = b - a, d = x - a;
    const double length = dot(e, e), t = length > 0 ? std::clamp(dot(d, e) / length, 0.0, 1.0) : 0;
    return dot(d - t * e, d - t * e);
}

double area_of(std::span<const Vec2> part) {
    double twice = 0;
    for (std::size_t i = 2; i < part.size(); ++i) twice += cross(part[i - 1] - part[0], part[i] - part[0]);
    return 0.5 * twice;
}

/// Cuts a convex part along the line through p and q, if the segment between them runs through it.
bool cut_part(const std::vector<Vec2>& part, Vec2 p, Vec2 q, double slack, std::vector<Vec2>& left,
              std::vector<Vec2>& right) {
    const double length = std::sqrt(dot(q - p, q - p));
    const Vec2 along = (1 / length) * (q - p);
    double enters = HUGE_VAL, leaves = -HUGE_VAL, lowest = 0, highest = 0;
    left.clear(), right.clear();
    for (std::size_t i = 0; i < part.size(); ++i) {
        const Vec2 a = part[i], b = part[i + 1 == part.size() ? 0 : i + 1];
        const double da = cross(along, a - p), db = cross(along, b - p);
        lowest = std::min(lowest, da), highest = std::max(highest, da);
        if (da >= 0) left.push_back(a);
        if (da <= 0) right.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            const Vec2 at = a + (da / (da - db)) * (b - a);
            left.push_back(at), right.push_back(at);
            enters = std::min(enters, dot(along, at - p)), leaves = std::max(leaves, dot(along, at - p));
        } else if (da == 0) {
            enters = std::min(enters, dot(along, a - p)), leaves = std::max(leaves, dot(along, a - p));
        }
    }
    return lowest < -slack && highest > slack && std::min(length, leaves) - std::max(0.0, enters) > slack;
}

}  // namespace

void ClutteredExchange::cut_along(Vec2 p, Vec2 q, double slack) {
    if (dot(q - p, q - p) <= slack * slack) return;
    Part left, right;
    next_.clear();
    for (Part& part : parts_) {
        if (cut_part(part, p, q, slack, left, right)) {
            next_.push_back(left);
            next_.push_back(right);
        } else {
            next_.push_back(std::move(part));
        }
    }
    parts_.swap(next_);
}

/// Where something stands on the receiver, what it sees jumps.
void ClutteredExchange::cut_along_contacts(double slack) {
    for (const ConvexBlocker* blocker : pair_.blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point &a = blocker->points[e.a], &b = blocker->points[e.b];
            if (std::abs(frame_.height(a)) > slack || std::abs(frame_.height(b)) > slack) continue;
            cut_along(frame_.flat(a), frame_.flat(b), slack);
        }
}

/// The parts as triangles and quadrilaterals.
void ClutteredExchange::add_cells() {
    for (const Part& part : parts_)
        for (std::size_t first = 1; first + 1 < part.size(); first += 2) {
            Cell cell{{part[0], part[first], part[first + 1]}, 3, 0, 0};
            if (first + 2 < part.size()) cell.corner[3] = part[first + 2], cell.count = 4;
            look(cell);
            total_ += cell.integral;
            heap_.push_back(cell);
        }
}

void ClutteredExchange::find_edges(double slack) {
    edges_.clear();
    const auto in_frame = [&](const Point& p) {
        const Vec2 flat = frame_.flat(p);
        return Point{flat.x, flat.y, frame_.height(p)};
    };
    for (const ConvexBlocker* blocker : pair_.blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point a = in_frame(blocker->points[e.a]), b = in_frame(blocker->points[e.b]);
            if (a.z > slack || b.z > slack) edges_.push_back({a, b, false});
        }
    std::stable_sort(edges_.begin(), edges_.end(),
                     [](const Edge& e, const Edge& f) { return std::max(e.a.z, e.b.z) < std::max(f.a.z, f.b.z); });
}

/// Where an edge passes closely over the receiver, what it sees nearly jumps.
void ClutteredExchange::cut_under_edges(double slack) {
    const double near = near_edge * std::sqrt(area_);
    for (Edge& e : edges_) {
        const Vec2 p = {e.a.x, e.a.y}, q = {e.b.x, e.b.y};
        if (parts_.size() > most_parts || std::max(e.a.z, e.b.z) > near) break;
        cut_along(p, q, slack);
        e.is_cut = true;
    }
}

/// How much of a cell may lie where edges change what is seen, from 0 to 1: all of it when one passes over it within
/// its size, a strip as wide as the edge is high if it has been cut along that edge.
double ClutteredExchange::share_under_edges(const Cell& cell) const {
    Vec2 middle{};
    for (std::size_t i = 0; i < cell.count; ++i) middle = middle + cell.corner[i];
    middle = (1.0 / cell.count) * middle;
    double squared = 0;
    for (std::size_t i = 0; i < cell.count; ++i)
        squared = std::max(squared, dot(cell.corner[i] - middle, cell.corner[i] - middle));
    const Point at = {middle.x, middle.y, 0};
    double share = 0;
    for (const Edge& edge : edges_) {
        if (squared_distance(at, edge.a, edge.b) >= squared) continue;
        if (!edge.is_cut) return 1;
        share = std::max(share, std::min(1.0, std::max(edge.a.z, edge.b.z) / std::sqrt(squared)));
    }
    return share;
}

/// What may have slipped between the points of a cell under an edge: some of what they saw, or of what little the cell
/// would hold if it saw less than a third of what the receiver sees on average.
double ClutteredExchange::unseen(const Cell& cell) const {
    const double area = area_of(std::span(cell.corner).first(cell.count));
    return 0.3 * std::max(cell.integral, 0.3 * total_ * area / area_);
}

/// What a cell of which no point has seen anything may hold. Nothing where one blocker hides all of it; past several
/// some of it may see through a gap, no more of it than light fades over the cell.
double ClutteredExchange::dark(const Cell& cell) {
    std::array<Point, 4> corners;
    for (std::size_t i = 0; i < cell.count; ++i) corners[i] = frame_.at(cell.corner[i]);
    if (visible_.is_hidden_from(std::span(corners).first(cell.count))) return 0;
    const double area = area_of(std::span(cell.corner).first(cell.count)), size = std::sqrt(area / area_);
    return dark_corner * brightest_ * size * area;
}

double ClutteredExchange::visible_at(Vec2 p, double weight) {
    ++evaluations;
    Seen seen;
    const double F = visible_(frame_.at(p), frame_.n, seen);
    brightest_ = std::max(brightest_, F);
    all_lit_ = all_lit_ && seen == Seen::all;
    return weight * F;
}

/// Two Gauss points a side; three on triangles.
void ClutteredExchange::look(Cell& cell) {
    cell.integral = 0;
    const Vec2 o = cell.corner[0], a = cell.corner[1] - o;
    if (cell.count == 3) {
        const Vec2 b = cell.corner[2] - o;
        const double area = std::abs(cross(a, b)) / 2;
        for (const PlanarNode& k : triangle_rule(2))
            cell.integral += visible_at(o + k.at.x * a + k.at.y * b, area * k.weight);
        return;
    }
    const Vec2 b = cell.corner[3] - o, c = cell.corner[2] - cell.corner[1] - b;
    for (const PlanarNode& k : square_rule(2)) {
        const double u = k.at.x, v = k.at.y;
        cell.integral += visible_at(o + u * a + v * b + (u * v) * c, k.weight * cross(a + v * c, b + u * c));
    }
}

/// Across its longest edge, and for a quadrilateral across the edge opposite to that.
void ClutteredExchange::halve_worst() {
    std::pop_heap(heap_.begin(), heap_.end());
    const Cell cell = heap_.back();
    heap_.pop_back();
    std::size_t longest = 0;
    double most = 0;
    for (std::size_t i = 0; i < cell.count; ++i) {
        const Vec2 e = cell.corner[(i + 1) % cell.count] - cell.corner[i];
        if (dot(e, e) > most) most = dot(e, e), longest = i;
    }
    const auto at = [&](std::size_t i) { return cell.corner[(longest + i) % cell.count]; };
    const Vec2 p = at(0) + ratio_ * (at(1) - at(0));
    Cell one{{}, cell.count, 0, 0}, two = one;
    if (cell.count == 3) {
        one.corner = {p, at(1), at(2)}, two.corner = {p, at(2), at(0)};
    } else {
        const Vec2 q = at(3) + ratio_ * (at(2) - at(3));
        one.corner = {p, at(1), at(2), q}, two.corner = {p, q, at(3), at(0)};
    }
    look(one), look(two);
    const double change = std::abs(one.integral + two.integral - cell.integral);
    // A bend across a cell leaves halves about a third each of what halving has changed. One that happens to change
    // nothing is not yet right.
    constexpr double left = 0.35, least = 0.2;
    const double error = std::max(left * change, least * std::min(cell.error, change + cell.integral));
    one.error = two.error = error;
    for (Cell* half : {&one, &two}) {
        if (cell.integral == 0 && cell.error == 0) continue;  // hidden for certain
        const double missed = half->integral == 0 ? dark(*half) : HUGE_VAL;
        half->error = std::max(half->error, share_under_edges(*half) * unseen(*half));
        if (missed == 0)
            half->error = 0;
        else if (missed < HUGE_VAL)
            half->error = std::max(half->error, missed);
    }
    total_ += one.integral + two.integral - cell.integral;
    squared_error_ += one.error * one.error + two.error * two.error - cell.error * cell.error;
    for (const Cell& half : {one, two}) {
        heap_.push_back(half);
        std::push_heap(heap_.begin(), heap_.end());
    }
}

double ClutteredExchange::operator()(const OccludedPair& pair, const Allowance& allowance, double ratio,
                                     bool& unoccluded) {
    unoccluded = false;
    ratio_ = ratio;
    brightest_ = 0;
    pair_ = pair;
    visible_.set(pair.source, pair.blockers);
    if (visible_.is_hidden_from(pair.receiver)) return 0;
    frame_ = PlaneFrame(pair.receiver[0], pair.receiver_plane.n);
    heap_.clear();
    total_ = squared_error_ = 0, all_lit_ = true;
    Part whole;
    for (const Point& p : pair.receiver) whole.push_back(frame_.flat(p));
    area_ = area_of(whole);
    const double slack = 1e-6 * std::sqrt(area_);
    parts_.assign(1, whole);
    cut_along_contacts(slack);
    find_edges(slack);
    cut_under_edges(slack);
    add_cells();
    if (brightest_ == 0) {
        Vec2 middle{};
        for (Vec2 p : whole) middle = middle + (1 / static_cast<double>(whole.size())) * p;
        brightest_ = unseen_brightness * visible_.unoccluded(frame_.at(middle), frame_.n);
    }
    for (Cell& cell : heap_) {
        const double cell_area = area_of(std::span(cell.corner).first(cell.count));
        cell.error = std::max({cell.integral, total_ * cell_area / area_, brightest_ * cell_area});  // unknown
        squared_error_ += cell.error * cell.error;
    }
    // Halved evenly at first: a sum of all that is seen must not rest on where the first few points happened to lie.
    std::make_heap(heap_.begin(), heap_.end());
    const std::size_t enough = evaluations + allowance.most_evaluations;
    while (heap_.size() < least_cells && total_ + std::sqrt(squared_error_) > 0) halve_worst();
    const auto good = [&] {
        const double error = std::sqrt(std::max(0.0, squared_error_));
        return error <= std::max(allowance.absolute, allowance.relative * total_) ||
               total_ + 2 * error < allowance.ignored;
    };
    for (std::size_t k = 1; !good() && evaluations < enough; ++k) {
        halve_worst();
        if (k % halvings_a_look == 0 && stop_.requested()) break;
    }
    if (all_lit_) return unoccluded = true, 0;
    double sum = 0;  // anew: the running one has rounded
    for (const Cell& cell : heap_) sum += cell.integral;
    return sum;
}

double crowding(const Plane& plane, double size, std::span<const ConvexBlocker* const> blockers) {
    double sum = 0;
    for (const ConvexBlocker* blocker : blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point &a = blocker->points[e.a], &b = blocker->points[e.b];
            const double height = 0.5 * (plane.signed_distance(a) + plane.signed_distance(b));
            if (height > 0) sum += norm(b - a) / std::max(height, 0.002 * size);
        }
    return sum;
}

}  // namespace exitance

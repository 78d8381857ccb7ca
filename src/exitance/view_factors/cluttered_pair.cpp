#include "exitance/view_factors/cluttered_pair.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/quadrature.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_parts = 48;  ///< Maximum number of parts of the receiver after it is cut below edges.
/// The receiver is cut below edges up to this height, as a share of its size. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3`: four times as much takes 1.5 times as long for a chair, a quarter is as good.
constexpr double max_cut_height = 0.1;
/// Error of a cell of which all points are dark: this share of the light that it would hold if light faded at a
/// constant slope over the whole receiver. Covers a bright corner that the points missed. Measured by `exitance
/// viewfactors SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors
/// nor times by more than 5%.
constexpr double dark_corner = 0.03;
/// Share of the whole source that may have been missed if no point saw any light. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times
/// by more than 5%.
constexpr double unseen_brightness = 0.05;
/// Share of a cell's size: strips of this width always contain points of its rules. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3`: half of it takes 8% longer for a table, twice is as good.
constexpr double between_points = 0.125;
/// Share of a strip's light that may be lost if no point is in it. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times by more
/// than 5%.
constexpr double unseen_strip = 0.1;
/// Share of the receiver's average light of which a strip may lose `unseen_strip`, if its points found less. Measured
/// by `exitance viewfactors SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change
/// neither errors nor times by more than 5%.
constexpr double unseen_average = 0.3;
/// Place of the cut of a cell in the second computation of a pair, whose points must differ from those of the first.
/// Measured by `exitance viewfactors SCENE --tolerance 1e-3`: half of it takes 1.1 times as long; values near 1 leave
/// the other part empty.
constexpr double uneven_halves = 0.45;
/// Smallest height of an edge over the receiver, as a share of its size, that counts for crowding(). Measured by
/// `exitance viewfactors SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change
/// neither errors nor times by more than 5%.
constexpr double min_crowding_height = 0.002;
/// Error of a cell as a share of the largest difference between its quadrature rules.
constexpr double error_per_difference = 0.5;
constexpr int max_halvings = 6;  ///< Limit on the halvings of a source.
/// A source is halved if its halves together have at most this many blockers for each one of the whole source.
/// Measured by `exitance viewfactors SCENE --tolerance 1e-3`: twice as much takes 6 to 12 times as long for a chair
/// and a table, half is as good.
constexpr double max_blocker_ratio = 1.4;
/// Share of the tolerance: errors of unoccluded cells below it are not reduced. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times
/// by more than 5%.
constexpr double exact_share = 0.1;

double area_of(std::span<const Vec2> part) {
    double twice = 0;
    for (std::size_t i = 2; i < part.size(); ++i) twice += cross(part[i - 1] - part[0], part[i] - part[0]);
    return 0.5 * twice;
}

/// Cuts a convex part along the line through p and q. Returns false if the segment between them does not pass through
/// it.
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

/// Cuts the receiver along its contacts with blockers, where visibility is discontinuous.
void ClutteredExchange::cut_along_contacts(double slack) {
    for (const ConvexBlocker* blocker : pair_.blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point &a = blocker->points[e.a], &b = blocker->points[e.b];
            if (std::abs(frame_.height(a)) > slack || std::abs(frame_.height(b)) > slack) continue;
            cut_along(frame_.flat(a), frame_.flat(b), slack);
        }
}

/// Splits the parts into triangles and quadrilaterals and evaluates these.
void ClutteredExchange::add_cells(const std::vector<SourcePart>& sources) {
    for (const Part& part : parts_)
        for (std::size_t first = 1; first + 1 < part.size(); first += 2) {
            Cell cell{{part[0], part[first], part[first + 1]}, 3, 0, 0, {}};
            if (first + 2 < part.size()) cell.corner[3] = part[first + 2], cell.count = 4;
            look(cell, sources);
            total_ += cell.integral;
            heap_.push_back(std::move(cell));
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
            Point a = in_frame(blocker->points[e.a]), b = in_frame(blocker->points[e.b]);
            if (a.z > b.z) std::swap(a, b);
            if (b.z > slack) edges_.push_back({a, b});
        }
    std::stable_sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) { return e.low.z < f.low.z; });
}

/// Cuts the receiver below edges that pass closely over it, where visibility is nearly discontinuous.
void ClutteredExchange::cut_under_edges(double slack) {
    const double near = max_cut_height * std::sqrt(area_);
    for (const Edge& e : edges_) {
        if (parts_.size() > max_parts || e.low.z > near) break;
        if (e.high.z <= near) cut_along({e.low.x, e.low.y}, {e.high.x, e.high.y}, slack);
    }
}

/// Share of a cell that may be below an edge that is closer to the cell than the points of its rules are to each other.
/// Visibility changes over a distance of about the edge's height; wider strips contain points.
double ClutteredExchange::share_under_edges(const Cell& cell) const {
    Vec2 middle{};
    for (std::size_t i = 0; i < cell.count; ++i) middle = middle + (1.0 / cell.count) * cell.corner[i];
    double squared = 0;
    for (Vec2 p : cell.corners()) squared = std::max(squared, dot(p - middle, p - middle));
    const Point at = {middle.x, middle.y, 0};
    const double size = std::sqrt(squared), widest = between_points * size;
    double share = 0;
    for (const Edge& edge : edges_) {
        if (edge.low.z > widest) break;
        const Vec3 along = edge.high - edge.low;
        const double t = edge.high.z > widest ? (widest - edge.low.z) / along.z : 1;
        const Point end = edge.low + t * along;
        if (squared_distance(at, edge.low, end) >= squared) continue;
        const double height = std::max(0.0, end.z), length = t * std::hypot(along.x, along.y);
        share = std::max(share, height / size * std::min(1.0, length / size));
    }
    return share;
}

/// Light that the points of a cell below an edge may have missed: a share of the light that they found or, if that is
/// little, a share of a third of the receiver's average.
double ClutteredExchange::unseen(const Cell& cell) const {
    return unseen_strip * std::max(cell.integral, unseen_average * total_ * area_of(cell.corners()) / area_);
}

/// Places the nodes of three rules without common nodes, the most accurate one last.
void ClutteredExchange::place_nodes(const Cell& cell) {
    nodes_.clear(), weights_.clear(), ends_.clear();
    const Vec2 o = cell.corner[0], a = cell.corner[1] - o;
    const int few = turned_ ? 5 : 4;
    if (cell.count == 3) {
        const Vec2 b = cell.corner[2] - o;
        const double area = 0.5 * std::abs(cross(a, b));
        for (int degree : {5, 2 * few - 1, 2 * few + 3}) {
            for (const PlanarNode& k : triangle_rule(degree))
                nodes_.push_back(o + k.at.x * a + k.at.y * b), weights_.push_back(area * k.weight);
            ends_.push_back(nodes_.size());
        }
        return;
    }
    const Vec2 b = cell.corner[3] - o, c = cell.corner[2] - cell.corner[1] - b;
    for (const auto& rule : {scattered_square_rule(), square_rule(few), square_rule(few + 2)}) {
        const bool mirrored = turned_ && ends_.empty();
        for (const PlanarNode& k : rule) {
            const double u = mirrored ? 1 - k.at.x : k.at.x, v = k.at.y;
            nodes_.push_back(o + u * a + v * b + (u * v) * c);
            weights_.push_back(k.weight * cross(a + v * c, b + u * c));
        }
        ends_.push_back(nodes_.size());
    }
}

ClutteredExchange::Blockers ClutteredExchange::seen_blockers() const {
    Blockers blockers;
    for (const SeenEdges& seen : visible_.seen_edges()) blockers.push_back(seen.body);
    return blockers;
}

/// Adds the halves of a source, cut across its longest edge. Returns false if the halves do not have far fewer
/// blockers.
bool ClutteredExchange::add_halves(Cell& cell, const SourcePart& source) {
    std::size_t longest = 0;
    Vec3 along;
    for (std::size_t i = 0; i < source.outline.size(); ++i) {
        const Vec3 e = source.outline[i + 1 == source.outline.size() ? 0 : i + 1] - source.outline[i];
        if (dot(e, e) > dot(along, along)) along = e, longest = i;
    }
    const Normal n = normalized(along);
    const double offset = dot(n, source.outline[longest] + 0.5 * along);
    std::array<SourcePart, 2> halves;
    std::size_t blockers = 0, open = 0;
    for (const double sign : {1.0, -1.0}) {
        SourcePart half{{}, {}, source.depth + 1};
        clip(source.outline, Plane{sign * n, sign * offset}, half.outline);
        if (half.outline.size() < 3 || half.outline.size() > SightTables::max_corners) return false;
        const auto outlook = visible_.set(frame_, cell.corners(), half.outline, source.blockers);
        if (outlook == VisibleFromMany::Outlook::partly) half.blockers = seen_blockers();
        blockers += half.blockers.size();
        if (outlook != VisibleFromMany::Outlook::hidden) halves[open++] = std::move(half);
    }
    if (static_cast<double>(blockers) > max_blocker_ratio * static_cast<double>(source.blockers.size())) return false;
    for (std::size_t k = 0; k < open; ++k) add_source(cell, halves[k]);
    return true;
}

/// Adds the light that a cell's points receive from a part of the source, and adds that part to the cell's sources.
void ClutteredExchange::add_source(Cell& cell, const SourcePart& source) {
    SourcePart part{source.outline, {}, source.depth};
    const auto outlook = visible_.set(frame_, cell.corners(), source.outline, source.blockers);
    if (outlook == VisibleFromMany::Outlook::hidden) {
        all_lit_ = false;
        return;
    }
    if (outlook == VisibleFromMany::Outlook::clear) {
        for (std::size_t k = 0; k < nodes_.size(); ++k) values_[k] += visible_.unoccluded(nodes_[k]);
        cell.sources.push_back(std::move(part));
        return;
    }
    part.blockers = seen_blockers();
    if (part.blockers.size() > SightTables::max_blockers) {
        if (part.depth < max_halvings && add_halves(cell, part)) return;
        visible_.set(frame_, cell.corners(), part.outline, part.blockers);
    }
    evaluations += nodes_.size();
    visible_(nodes_, ends_, factors_, seen_);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        values_[k] += factors_[k];
        all_lit_ = all_lit_ && seen_[k] == Seen::all;
    }
    cell.sources.push_back(std::move(part));
}

/// Returns the contour integral of a cell whose sources are all unoccluded.
double ClutteredExchange::exact(const Cell& cell) const {
    std::array<Point, 4> corners;
    for (std::size_t i = 0; i < cell.count; ++i) corners[i] = frame_.at(cell.corner[i]);
    double sum = 0;
    for (const SourcePart& source : cell.sources)
        sum += exchange_area(std::span(corners).first(cell.count), source.outline, exact_share * relative_);
    return sum;
}

/// Computes the integral of a cell and its error from its two rules.
void ClutteredExchange::judge(Cell& cell) {
    double most = 0, sum = 0;
    std::size_t k = 0;
    std::array<double, 3> found{};
    for (std::size_t rule = 0; rule < ends_.size(); ++rule)
        for (; k < ends_[rule]; ++k)
            found[rule] += weights_[k] * values_[k], brightest_ = std::max(brightest_, values_[k]);
    sum = found.back();
    for (const double other : found) most = std::max(most, std::abs(sum - other));
    cell.integral = sum, cell.error = error_per_difference * most;
    if (cell.sources.empty()) {
        cell.error = 0;  // no source is left, so the cell is certainly hidden
        return;
    }
    const bool clear = std::ranges::all_of(cell.sources, [](const SourcePart& s) { return s.blockers.empty(); });
    if (clear && cell.error > exact_share * relative_ * sum) cell.integral = exact(cell), cell.error = 0;
    if (clear) return;
    // Between several blockers part of a dark cell may see light through a gap; bounded by the slope of light over the
    // receiver.
    const double area = area_of(cell.corners());
    if (sum == 0) cell.error = dark_corner * brightest_ * area * std::sqrt(area / area_);
    cell.error = std::max(cell.error, share_under_edges(cell) * unseen(cell));
}

void ClutteredExchange::look(Cell& cell, const std::vector<SourcePart>& sources) {
    place_nodes(cell);
    values_.assign(nodes_.size(), 0), factors_.resize(nodes_.size()), seen_.resize(nodes_.size());
    for (const SourcePart& source : sources) add_source(cell, source);
    judge(cell);
}

/// Halves the cell with the largest error.
void ClutteredExchange::halve_worst() {
    std::pop_heap(heap_.begin(), heap_.end());
    const Cell cell = std::move(heap_.back());
    heap_.pop_back();
    const double ratio = turned_ ? uneven_halves : 0.5;
    const auto corners = halves_of(cell.corners(), ratio);
    Cell one{corners[0], cell.count, 0, 0, {}}, two{corners[1], cell.count, 0, 0, {}};
    look(one, cell.sources), look(two, cell.sources);
    total_ += one.integral + two.integral - cell.integral;
    squared_error_ += one.error * one.error + two.error * two.error - cell.error * cell.error;
    for (Cell* half : {&one, &two}) {
        heap_.push_back(std::move(*half));
        std::push_heap(heap_.begin(), heap_.end());
    }
}

double ClutteredExchange::operator()(const OccludedPair& pair, const Allowance& allowance, bool turned,
                                     bool& unoccluded) {
    unoccluded = false;
    turned_ = turned, relative_ = allowance.relative;
    pair_ = pair;
    frame_ = PlaneFrame(pair.receiver[0], pair.receiver_plane.n);
    heap_.clear();
    total_ = squared_error_ = 0, all_lit_ = true;
    Part whole;
    Vec2 middle{};
    for (const Point& p : pair.receiver) {
        whole.push_back(frame_.flat(p));
        middle = middle + (1 / static_cast<double>(pair.receiver.size())) * whole.back();
    }
    const auto outlook = visible_.set(frame_, whole, pair.source, pair.blockers);
    if (outlook == VisibleFromMany::Outlook::hidden) return 0;
    if (outlook == VisibleFromMany::Outlook::clear) return unoccluded = true, 0;
    brightest_ = unseen_brightness * visible_.unoccluded(middle);
    area_ = area_of(whole);
    const double slack = coplanar_share * std::sqrt(area_);
    parts_.assign(1, whole);
    const std::vector<SourcePart> sources = {{{pair.source.begin(), pair.source.end()}, seen_blockers(), 0}};
    cut_along_contacts(slack);
    find_edges(slack);
    cut_under_edges(slack);
    const std::size_t enough = evaluations + allowance.max_evaluations;
    add_cells(sources);
    for (const Cell& cell : heap_) squared_error_ += cell.error * cell.error;
    std::make_heap(heap_.begin(), heap_.end());
    const auto good = [&] {
        const double error = std::sqrt(std::max(0.0, squared_error_));
        return error <= std::max(allowance.absolute, allowance.relative * total_) ||
               total_ + 2 * error < allowance.ignored;
    };
    while (heap_.front().error > 0 && !good() && evaluations < enough && !stop_.requested()) halve_worst();
    if (all_lit_) return unoccluded = true, 0;
    double sum = 0;  // a new sum: the running one has accumulated rounding errors
    for (const Cell& cell : heap_) sum += cell.integral;
    return sum;
}

double crowding(const Plane& plane, double size, std::span<const ConvexBlocker* const> blockers) {
    double sum = 0;
    for (const ConvexBlocker* blocker : blockers)
        for (const ConvexBlocker::Edge& e : blocker->edges) {
            const Point &a = blocker->points[e.a], &b = blocker->points[e.b];
            const double height = 0.5 * (plane.signed_distance(a) + plane.signed_distance(b));
            if (height > 0) sum += norm(b - a) / std::max(height, min_crowding_height * size);
        }
    return sum;
}

}  // namespace exitance

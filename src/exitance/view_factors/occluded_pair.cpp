#include "exitance/view_factors/occluded_pair.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"

namespace exitance {
namespace {

constexpr int max_depth = 20;  ///< Halvings of a cell, at most: down to 1e-3 of its size in each direction.
/// Share of the tolerance that applies to entries that dominate their row. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3`: twice as much saves 9% for a table, half is as good.
constexpr double dominating_share = 0.25;
/// Share of the light that a dark cell may receive, if parts of it may be lit. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times
/// by more than 5%.
constexpr double dark_cell_share = 0.05;
/// Share of the whole source that may be visible although no point saw it. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times by more
/// than 5%.
constexpr double unseen_share = 0.05;
/// Share of demand.ignored. Estimates below it are treated as negligible; between it and 1 they may be too inaccurate
/// for that. Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair, a table and an office: half and
/// twice of it change neither errors nor times by more than 5%.
constexpr double surely_ignored = 0.3;
/// Share of a cell's allowed error that its rules may have due to the nearness of the source alone. With the full
/// allowance, cells along a common edge with the source would fail at every size, as their distance from it is
/// proportional to their size. Measured by `exitance viewfactors SCENE --tolerance 1e-3`: half and twice change times
/// by less than 7% and errors not at all.
constexpr double near_part = 0.1;
/// A cell is below an edge that passes its middle at less than this times the squared distance of its farthest
/// corner. Measured by `exitance viewfactors SCENE --tolerance 1e-3`: half of it saves 7% for a table, twice is as
/// good.
constexpr double under_edge = 1.5;
/// Errors of 2 x 2 points, see OccludedExchange::is_settled_by_two_points(): of d, for triangles and quadrangles; of
/// the value, by the largest deviation and by the variation. For entries that matter, and for others.
struct TwoPointError {
    double of_triangle, of_quad, of_most;
    double variations;  ///< Variations, squared, per error of the value.
};
/// Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair: a quarter or four times of any of the eight
/// numbers changes errors by less than 5%.
constexpr TwoPointError of_large{0.2, 0.03, 0.005, 270}, of_small{0.05, 0.005, 0.001, 2700};
/// Tolerance below which cells are treated like those of entries that matter. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3` for a chair, a table and an office: half and twice of it change neither errors nor times by more
/// than 5%.
constexpr double fine_tolerance = 1e-5;
/// Error of the better of two rules as a share of their difference: behind several edges or in entries that matter,
/// and behind one. Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair, a table and an office: half
/// and twice of it change neither errors nor times by more than 5%.
constexpr double left_behind_edges = 0.1, left_behind_one = 0.03;
/// Share of a cell's allowed error for its contour integral, and the limits of that tolerance. Measured by `exitance
/// viewfactors SCENE --tolerance 1e-3` for a chair: a quarter and four times of it change neither errors nor times by
/// more than 5%.
constexpr double exact_cell_share = 0.1, min_contour = 1e-12, max_contour = 1e-3;
/// Allowed error of estimates below `surely_ignored`, as a share of demand.ignored. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3` for a chair: a quarter and four times of it change neither errors nor times by more than
/// 5%.
constexpr double ignored_share = 0.1;
/// Share of a cell's allowed error for cells that see the whole source, or little light. Measured by `exitance
/// viewfactors SCENE --tolerance 1e-3` for a chair: a quarter and four times of it change neither errors nor times by
/// more than 5%.
constexpr double smooth_share = 0.3;
constexpr double near_share = 0.5;  ///< Error of the better of two rules at an edge, as a share of their difference.

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

/// Distance from a point to a convex polygon with normal n, metres.
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

/// Evaluates the visible part of the source from all placed nodes.
void OccludedExchange::look_from_nodes() {
    evaluations += nodes_.size();
    factors_.resize(nodes_.size()), seen_.resize(nodes_.size());
    visible_(nodes_, lasts_, factors_, seen_);
}

void OccludedExchange::Glance::take(double F, Seen seen) {
    ++count, dark += seen == Seen::nothing, lit += seen == Seen::all;
    black += seen <= Seen::nothing_past_several;
    lowest = std::min(lowest, F), highest = std::max(highest, F);
}

/// Evaluates cells with 2 x 2 Gauss points.
void OccludedExchange::look_at_cells(std::span<Cell* const> cells) {
    nodes_.clear(), weights_.clear(), lasts_.clear();
    for (const Cell* cell : cells) place_nodes(*cell, 2), lasts_.push_back(nodes_.size());
    look_from_nodes();
    std::size_t k = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        Cell& cell = *cells[i];
        cell.area = std::max(0.0, cross_area(cell.corners()));
        cell.glance = {};
        cell.two_points = 0;
        for (; k < lasts_[i]; ++k) {
            cell.two_points += weights_[k] * factors_[k];
            cell.glance.take(factors_[k], seen_[k]);
        }
    }
}

/// Evaluates the centres of the cells for which two points per side may suffice.
void OccludedExchange::look_from_middles() {
    nodes_.clear(), weights_.clear(), lasts_.clear();
    for (const Task& task : tasks_)
        if (task.cell.glance.black == 0)
            nodes_.push_back(middle_of(task.cell.corners())), lasts_.push_back(nodes_.size());
    look_from_nodes();
    std::size_t k = 0;
    for (Task& task : tasks_)
        if (task.cell.glance.black == 0) task.cell.middle = factors_[k++];
}

std::array<std::array<Vec2, 4>, 2> halves_of(std::span<const Vec2> corners, double ratio) {
    std::size_t longest = 0;
    double most = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 e = corners[(i + 1) % corners.size()] - corners[i];
        if (dot(e, e) > most) most = dot(e, e), longest = i;
    }
    const auto at = [&](std::size_t i) { return corners[(longest + i) % corners.size()]; };
    const Vec2 p = at(0) + ratio * (at(1) - at(0));
    if (corners.size() == 3) return {{{p, at(1), at(2)}, {p, at(2), at(0)}}};
    const Vec2 q = at(3) + ratio * (at(2) - at(3));
    return {{{p, at(1), at(2), q}, {p, q, at(3), at(0)}}};
}

void OccludedExchange::halve(const Task& task) {
    for (const std::array<Vec2, 4>& corners : halves_of(task.cell.corners())) {
        Task half{{}, 0, 0.5 * task.allowed, 0, {}, task.depth + 1};
        half.cell.count = task.cell.count, half.cell.corner = corners;
        halves_.push_back(half);
    }
}

/// Lower bound on the distance of a cell from the source polygon itself; bounding boxes of slanting faces extend far
/// beyond them.
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

/// Upper bound on the form factor to the source from points of a cell at distance d.
double OccludedExchange::brightest(double d) const {
    return source_area_ < pi * d * d ? source_area_ / (pi * d * d) : 1;
}

/// Factor rho by which errors decrease. If an integrand is analytic except at a distance of g cell sizes (here the
/// source), n Gauss points per side have an error of about rho^(-2n), with rho = 1 + 2g + 2 sqrt(g + g^2).
double OccludedExchange::convergence(const Cell& cell, double d) const {
    const double g = d / diameter(cell.corners());
    return 1 + 2 * g + 2 * std::sqrt(g + g * g);
}

/// Integral over a cell that sees the whole source, with as many Gauss points as its distance requires.
double OccludedExchange::integrate_smooth(const Cell& cell, double d, double allowed) {
    const double rho = convergence(cell, d);
    const double whole = cell.area * brightest(d);
    constexpr double rounding = 1e-16;    // derived from double precision
    constexpr double least_rho = 1.0001;  // derived from its logarithm, by which is divided
    const double wanted = std::max(allowed, rounding * whole);
    const double digits = whole > wanted ? std::log(whole / wanted) : 0;
    const int points = std::max(2, static_cast<int>(std::ceil(digits / (2 * std::log(std::max(rho, least_rho))))));
    if (points == 2 && cell.count == 4) return cell.two_points;
    if (points > 8) return exact(cell, allowed);  // the cell is too near to the source for Gauss points
    nodes_.clear(), weights_.clear();
    place_nodes(cell, points);
    double sum = 0;
    for (std::size_t k = 0; k < nodes_.size(); ++k) sum += weights_[k] * visible_.unoccluded(nodes_[k]);
    return sum;
}

/// True if an edge of a blocker passes over the cell at less than its size. The visible part then changes over a
/// distance of about the edge's height. That may happen between the points of a rule, so that rules agree and are
/// wrong.
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
            if (squared_distance(middle, a, b) < under_edge * squared) return true;
        }
    return false;
}

/// True if 2 x 2 points are accurate enough. The difference d of two rules is the error of the worse one, the centre
/// alone. If the curvature has one sign, the better one errs by about d^2 / 7 of the value. Curvatures of opposite sign
/// cancel in d, so that a second criterion is needed: exp(a s) on [-1, 1] has the error a^4 / 270 and the variation v =
/// a / sqrt 3 at the points; any variation may cause a small error. The factors are from 45,000 cells of a room with
/// blocks: as many cells as possible are accepted, and one of 140 errs by more than its allowance.
bool OccludedExchange::is_settled_by_two_points(const Task& task) const {
    const Cell& cell = task.cell;
    if (task.whole >= 0 || cell.glance.black > 0 || (dominates_ && is_under_an_edge(cell))) return false;
    const double rho = convergence(cell, task.distance), step = 1 / (rho * rho);
    const double far = 2 * cell.area * brightest(task.distance), middle = std::max(cell.middle, min_divisor);
    const double most = std::max(cell.glance.highest / middle - 1, 1 - cell.glance.lowest / middle),
                 varies = 3 * most * most, d = std::abs(cell.two_points - cell.area * middle);
    const bool is_triangle = cell.count == 3;  // three points of a triangle have only degree 2
    const TwoPointError& share = matters_ ? of_large : of_small;
    const double steep = matters_ ? 0 : 2 * d / std::max(cell.two_points, min_divisor);
    const double error = ((is_triangle ? share.of_triangle : share.of_quad) + steep) * d +
                         cell.two_points * (varies * varies / share.variations + share.of_most * most);
    return error + far * step * step <= task.allowed;
}

/// Error of the better of two rules as a share of their difference. Behind several blockers the visible part may have
/// kinks within a cell, where a line of sight touches three edges.
double OccludedExchange::share_left(const Task& task) const {
    if ((dominates_ || task.whole >= 0) && is_under_an_edge(task.cell)) return near_share;
    if (matters_ || relative_ < fine_tolerance) return left_behind_edges;
    return visible_.seen_edges().size() > 1 ? left_behind_edges : left_behind_one;
}

/// Light that a cell may receive although all its points are dark. Zero if no critical line crosses it, else that of a
/// bright corner which the points missed, with the slope of light over the whole receiver.
double OccludedExchange::dark(const Cell& cell) const {
    if (cell.complete) return 0;
    return dark_cell_share * brightest_seen_ * cell.area * std::sqrt(cell.area / receiver_area_);
}

/// Applies a rule to the cells of all tasks.
void OccludedExchange::apply(int points) {
    nodes_.clear(), weights_.clear(), lasts_.clear();
    for (const Task& task : tasks_) place_nodes(task.cell, points), lasts_.push_back(nodes_.size());
    look_from_nodes();
    std::size_t k = 0;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
        Task& task = tasks_[i];
        const bool near = task.whole >= 0;
        task.sum = near ? task.whole : 0;
        task.glance = {};
        for (; k < lasts_[i]; ++k) {
            task.sum += weights_[k] * (near ? factors_[k] - visible_.unoccluded(nodes_[k]) : factors_[k]);
            task.glance.take(factors_[k], seen_[k]);
        }
    }
}

/// True if the source is so near that a rule with this many points per side is inaccurate even without occlusion.
bool OccludedExchange::is_near(const Task& task, int points) const {
    const double rho = convergence(task.cell, task.distance);
    return 2 * task.cell.area * brightest(task.distance) * std::pow(rho, -2 * points) > near_part * task.allowed;
}

/// Contour integral over a cell without occlusion.
double OccludedExchange::exact(const Cell& cell, double allowed) const {
    std::array<Point, 4> corners;
    for (std::size_t i = 0; i < cell.count; ++i) corners[i] = frame_.at(cell.corner[i]);
    const double most = cell.area * brightest(0);
    return exchange_area(std::span(corners).first(cell.count), pair_.source,
                         std::clamp(exact_cell_share * allowed / most, min_contour, max_contour));
}

/// Prepares cells near the source: their unoccluded integral is exact, and rules integrate only the hidden part, which
/// is no nearer than its blockers. Finishes cells that see the whole source, and returns their sum.
double OccludedExchange::settle_near_cells(int points) {
    double total = 0;
    std::erase_if(tasks_, [&](Task& task) {
        const Glance& glance = task.cell.glance;
        if (glance.black == glance.count || !is_near(task, points)) return false;
        task.whole = exact(task.cell, task.allowed);
        if (task.cell.complete && glance.lit == glance.count) return total += task.whole, true;
        nodes_.clear(), weights_.clear();
        place_nodes(task.cell, 2);
        task.sum = task.whole + task.cell.two_points;
        for (std::size_t k = 0; k < nodes_.size(); ++k) task.sum -= weights_[k] * visible_.unoccluded(nodes_[k]);
        return false;
    });
    return total;
}

/// Applies rules of increasing order until two agree, else halves the cell. The better one's error is a small share of
/// their difference, but at least that due to the source's distance. The shares are from cells of rooms with blocks: of
/// 150 accepted cells one errs by more than its allowance, of 2300 one by ten times that.
double OccludedExchange::integrate_tasks() {
    const bool fine = relative_ < fine_tolerance || dominates_;
    double total = 0;
    while (!tasks_.empty() && !stop_.requested()) {
        total += settle_near_cells(fine ? 5 : 3);
        if (fine) {
            apply(3);
        } else {
            look_from_middles();
            std::erase_if(tasks_, [&](const Task& task) {
                const bool settled = is_settled_by_two_points(task);
                if (settled) total += task.cell.two_points;
                return settled;
            });
        }
        for (int points : fine ? std::array{5, 8} : std::array{3, 4}) {
            befores_.clear();
            for (const Task& task : tasks_) befores_.push_back(task.sum);
            apply(points);
            std::size_t i = 0;
            std::erase_if(tasks_, [&](const Task& task) {
                const double before = befores_[i++];
                const Cell& cell = task.cell;
                if (task.glance.black == task.glance.count) return dark(cell) <= std::max(task.allowed, ignored_);
                const double rho = convergence(cell, task.distance), step = 1 / (rho * rho);
                const double far = task.whole >= 0 ? 0 : 2 * cell.area * brightest(task.distance);
                const bool good =
                    share_left(task) * std::abs(task.sum - before) + far * std::pow(step, points) <= task.allowed;
                if (good) total += task.sum;
                return good;
            });
            if (!fine) break;
        }
        halves_.clear();
        for (const Task& task : tasks_) {
            if (task.depth >= max_depth || evaluations > enough_)
                total += task.sum;
            else
                halve(task);
        }
        looking_.clear();
        for (Task& half : halves_) looking_.push_back(&half.cell);
        look_at_cells(looking_);
        for (Task& half : halves_) half.distance = distance_to_source(half.cell), half.sum = half.cell.two_points;
        tasks_.swap(halves_);
    }
    return total;
}

std::optional<double> OccludedExchange::operator()(const OccludedPair& pair, const Demand& demand, bool& unoccluded) {
    unoccluded = false;
    pair_ = pair;
    relative_ = demand.relative;
    frame_ = PlaneFrame(pair.receiver[0], pair.receiver_plane.n);
    Part whole;
    for (const Point& p : pair.receiver) whole.add(frame_.flat(p));
    const auto outlook = visible_.set(frame_, whole.corners(), pair.source, pair.blockers);
    if (outlook == VisibleFromMany::Outlook::hidden) return 0;
    if (outlook == VisibleFromMany::Outlook::clear) return unoccluded = true, 0;
    max_cells_ = demand.max_cells;
    size_ = diameter(whole.corners());
    cells_.clear();
    cut_into_cells(whole, 0);
    if (cells_.size() > max_cells_) return std::nullopt;
    looking_.clear();
    for (Cell& cell : cells_) looking_.push_back(&cell);
    look_at_cells(looking_);

    bool all = true;
    double estimate = 0;
    brightest_seen_ = unseen_share * visible_.unoccluded(middle_of(whole.corners()));
    receiver_area_ = std::max(cross_area(whole.corners()), min_divisor);
    for (const Cell& cell : cells_) {
        all &= cell.complete && cell.glance.lit == cell.glance.count;
        estimate += cell.two_points;
        if (cell.glance.black < cell.glance.count) brightest_seen_ = std::max(brightest_seen_, cell.glance.highest);
    }
    if (all) return unoccluded = true, 0;

    ignored_ = ignored_share * demand.ignored;
    matters_ = estimate > demand.large;
    dominates_ = estimate > demand.dominating;
    const double never_matters = estimate < surely_ignored * demand.ignored ? ignored_ : demand.absolute;
    const double allowed = std::max((dominates_ ? dominating_share : 1) * demand.relative * estimate, never_matters);
    source_area_ = norm(area_vector(pair.source));
    const double share = allowed / std::sqrt(static_cast<double>(cells_.size()));
    double total = 0;
    tasks_.clear();
    for (const Cell& cell : cells_) {
        if (cell.complete && cell.glance.dark == cell.glance.count) continue;
        const double d = distance_to_source(cell);
        if (cell.complete && cell.glance.lit == cell.glance.count)
            total += integrate_smooth(cell, d, smooth_share * share);
        else if (cell.area * brightest(d) < smooth_share * share)
            total += cell.two_points;
        else
            tasks_.push_back({cell, d, share, cell.two_points, cell.glance, 0});
    }
    enough_ = evaluations + cells_.size() * (relative_ < fine_tolerance ? 1000 : 50) * (1 + 1000 / cells_.size());
    return total + integrate_tasks();
}

}  // namespace exitance

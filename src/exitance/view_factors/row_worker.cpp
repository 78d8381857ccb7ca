#include "exitance/view_factors/row_worker.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exitance/base/limits.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"
#include "exitance/view_factors/accuracy.hpp"

namespace exitance {
namespace {

/// Larger entries may be among the largest of their row. Measured by `exitance viewfactors SCENE --tolerance 1e-3`
/// for a chair: a quarter and four times of it change errors by less than 5%.
constexpr double large_entry = 3e-4;
/// Larger entries determine their row's error. Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair:
/// a quarter takes 5% longer, four times saves 4%; errors stay.
constexpr double dominating_entry = 0.03;
/// With more blockers, critical lines cut large faces into thousands of cells.
constexpr std::size_t few_blockers = 12;
/// With more blockers, finding critical lines takes longer than integration without them.
constexpr std::size_t many_blockers = 20;
constexpr double alike_areas = 4;  ///< Ratio of areas below which either face may be the receiver.
constexpr std::size_t patient_evaluations = 500'000;
constexpr double min_crowding_ratio = 8;  ///< Ratio of crowding() above which the less crowded face is the receiver.
constexpr double max_area_ratio = 16;     ///< Ratio of areas above which the smaller face is the receiver.
constexpr double max_area_ratio_cluttered = 2;  ///< Like max_area_ratio, if there are more than few_blockers blockers.
/// Tolerance of contour sums for single entries. The terms of the sums cancel if the sizes of two faces are very
/// different: with a tenth of the entry's tolerance, one entry was wrong by 0.6%. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3`: a quarter and four times of it give the same errors and times for a chair.
constexpr double entry_contour_share = 1e-4;

/// Limit on the cells into which critical lines may cut a receiver. Cells cost the same at any tolerance; without
/// lines the work grows with the given power of 1 / tolerance. Measured in an office at 1e-3: up to 300 cells took
/// 0.02 to 2 ms per pair and one of 60 pairs missed the tolerance; halving alone took four times as long and missed
/// ten. Measured by `exitance viewfactors SCENE --tolerance 1e-3` for a chair: a quarter of the cells saves 30% of
/// the time, four times as many take three times as long.
constexpr double cells_at_a_thousandth = 300, power_of_halving = 0.75;

/// Convergence rate below which a pair is too near for Gauss points. Measured by `exitance viewfactors SCENE
/// --tolerance 1e-3` for a chair: a quarter and four times of it change neither errors nor times by more than 5%.
constexpr double min_convergence = 1.5;
/// Share of the tolerance for the error of Gauss points. Measured by `exitance viewfactors SCENE --tolerance 1e-3`
/// for a chair: a quarter and four times of it change neither errors nor times by more than 5%.
constexpr double gauss_share = 0.01;

std::size_t max_cells(double tolerance) {
    // The tolerance that the number of cells is for. Derived from cells_at_a_thousandth.
    constexpr double thousandth = 1e-3;
    return static_cast<std::size_t>(cells_at_a_thousandth * std::pow(thousandth / tolerance, power_of_halving));
}

}  // namespace

/// Number of Gauss points per side for an unoccluded receiver; above max_points if the pair is too near. The integrand
/// is analytic except at the source, which is g receiver sizes away.
int RowWorker::points_for(const ViewFace& receiver, const ViewFace& source) const {
    const Vec3 apart = max(max(source.box.lo - receiver.box.hi, receiver.box.lo - source.box.hi), Vec3{});
    const double g = norm(apart) / receiver.diameter, rho = 1 + 2 * g + 2 * std::sqrt(g + g * g);
    if (rho < min_convergence) return max_points + 1;
    // A source near a large receiver is brighter somewhere than on average, by about the receiver's area over the
    // squared distance, which requires that many more digits.
    const double peak = std::max(1.0, receiver.area / std::max(dot(apart, apart), min_divisor));
    return std::max(2, static_cast<int>(std::ceil(std::log(peak / (gauss_share * tolerance_)) / (2 * std::log(rho)))));
}

void RowWorker::add_unoccluded(std::size_t i, std::size_t j, bool cut) {
    const ViewFace &receiver = pairs_.faces()[i], &source = pairs_.faces()[j];
    const int points = cut || !source.is_quad ? max_points + 1 : points_for(receiver, source);
    if (points > max_points) {
        exact_.push_back(static_cast<std::uint32_t>(j));
        return;
    }
    Batch& batch = batches_[static_cast<std::size_t>(points)];
    const std::span<const Point> o = source.outline;
    batch.quads.add({o[0], o[1], o[2], o.back()});
    batch.faces.push_back(static_cast<std::uint32_t>(j));
}

/// Makes the Gauss points of a whole receiver; weights sum to one.
void RowWorker::make_nodes(const ViewFace& receiver, int points) {
    nodes_.clear();
    for (const std::vector<Point>& piece : receiver.pieces)
        for (std::size_t first = 1; first + 1 < piece.size(); first += 2) {
            const Point& o = piece[0];
            const Vec3 a = piece[first] - o;
            if (first + 2 == piece.size()) {  // a triangle
                const Vec3 b = piece[first + 1] - o;
                const double area = 0.5 * dot(receiver.plane.n, cross(a, b)) / receiver.area;
                for (const PlanarNode& k : triangle_rule(2 * points - 1))
                    nodes_.push_back({o + k.at.x * a + k.at.y * b, area * k.weight});
                continue;
            }
            const Vec3 b = piece[first + 2] - o, c = piece[first + 1] - piece[first] - b;
            for (const PlanarNode& k : square_rule(points)) {
                const double u = k.at.x, v = k.at.y;
                const double area = dot(receiver.plane.n, cross(a + v * c, b + u * c)) / receiver.area;
                nodes_.push_back({o + u * a + v * b + (u * v) * c, area * k.weight});
            }
        }
}

/// Integrates the collected unoccluded pairs: analytically in the source, by Gauss points on the receiver, for many
/// sources at a time.
void RowWorker::flush_batches(std::size_t i, std::span<double> row) {
    const ViewFace& receiver = pairs_.faces()[i];
    for (std::size_t points = 2; points < batches_.size(); ++points) {
        Batch& batch = batches_[points];
        if (batch.faces.empty()) continue;
        make_nodes(receiver, static_cast<int>(points));
        values_.resize(batch.faces.size());
        for (const Node& node : nodes_) {
            point_to_quads(node.at, receiver.plane.n, batch.quads, values_);
            for (std::size_t k = 0; k < values_.size(); ++k) row[batch.faces[k]] += node.weight * values_[k];
        }
        batch.quads.clear();
        batch.faces.clear();
    }
    for (std::uint32_t j : exact_)
        row[j] = exchange_area(receiver.outline, pairs_.faces()[j].outline, entry_contour_share * tolerance_) /
                 receiver.area;
    exact_.clear();
}

/// Exchange area of one convex piece of the receiver and one of the source, each in front of the other's plane.
double RowWorker::occluded_pieces(const ViewFace& receiver, const ViewFace& source, std::span<const Point> r,
                                  std::span<const Point> s, bool& unoccluded) {
    const double smallest = smallest_entry * std::min(source.area, receiver.area);
    const OccludedPair straight{r, s, receiver.plane, source.plane, standing_between_},
        back{s, r, source.plane, receiver.plane, standing_between_};
    // The view of a small face from a large one varies within the size of the small one; then the small one is the
    // receiver. No critical lines are used in that case: the small face's own row uses the same lines, and both rows
    // would have the same error.
    const double larger = standing_between_.size() > few_blockers ? max_area_ratio_cluttered : max_area_ratio;
    if (!is_cluttered_ && larger * source.area >= receiver.area) {
        Demand demand{.relative = tolerance_, .absolute = tolerance_ * smallest, .ignored = smallest};
        demand.large = large_entry * receiver.area, demand.dominating = dominating_entry * receiver.area;
        demand.max_cells = max_cells(tolerance_);
        if (const std::optional<double> found = exchange_(straight, demand, unoccluded)) return *found;
    }
    // If both faces have a similar size, the one with fewer nearby blockers is the receiver.
    const bool alike = source.area < alike_areas * receiver.area && receiver.area < alike_areas * source.area;
    const bool turned = alike ? min_crowding_ratio * crowding(source.plane, source.diameter, standing_between_) <
                                    crowding(receiver.plane, receiver.diameter, standing_between_)
                              : source.area < receiver.area;
    const ClutteredExchange::Allowance allowance{0.5 * tolerance_, tolerance_ * smallest, is_alone_ ? 0 : smallest,
                                                 max_evaluations_};
    return turned ? cluttered_exchange_(back, allowance, true, unoccluded)
                  : cluttered_exchange_(straight, allowance, false, unoccluded);
}

/// Keeps the remaining part of a blocker if it may still hide something.
void RowWorker::add_clipped(ConvexBlocker&& part, const ViewFace& receiver, const ViewFace& source) {
    const std::uint8_t by_r = pairs_.standing(part, receiver.plane), by_s = pairs_.standing(part, source.plane);
    if (!(by_r & ViewPairs::in_front) || !(by_s & ViewPairs::in_front)) return;
    if (sides(part, receiver.outline, pairs_.slack()) & sides(part, source.outline, pairs_.slack())) return;
    clipped_.push_back(std::move(part));
    standing_between_.push_back(&clipped_.back());
}

/// True if parts of two faces must be cut off, since faces that touch both hide them.
bool RowWorker::has_hidden_parts(std::size_t i, std::size_t j) const {
    return pairs_.hidden_parts().count_from(i, j, 1) > 0 || pairs_.hidden_parts().count_from(j, i, 1) > 0;
}

/// F_ij with blockers, or with hidden parts. Of a blocker that crosses the plane of either face, only the part in front
/// of both counts.
double RowWorker::occluded(std::size_t i, std::size_t j, std::span<const std::uint32_t> blockers, bool& unoccluded) {
    const ViewFace &receiver = pairs_.faces()[i], &source = pairs_.faces()[j];
    standing_between_.clear();
    clipped_.clear();
    for (std::uint32_t b : blockers) {
        const ConvexBlocker& blocker = pairs_.blockers()[b];
        if (!pairs_.crosses(i, b) && !pairs_.crosses(j, b)) {
            standing_between_.push_back(&blocker);
            continue;
        }
        ConvexBlocker before_source, before_both;
        if (blocker.is_solid() && clip_body(blocker, source.plane, pairs_.slack(), before_source) &&
            clip_body(before_source, receiver.plane, pairs_.slack(), before_both)) {
            if (!before_both.points.empty()) add_clipped(std::move(before_both), receiver, source);
            continue;
        }
        for (std::size_t k = 0; k < blocker.faces.size(); ++k) {
            front_r_.clear();
            for (std::uint32_t c : blocker.loops[k]) front_r_.push_back(blocker.points[c]);
            clip(front_r_, source.plane, front_s_);
            clip(front_s_, receiver.plane, front_r_);
            if (!front_r_.empty()) add_clipped(make_sheet(front_r_, blocker.faces[k]), receiver, source);
        }
    }
    const ConvexParts &of_receiver = pairs_.hidden_parts().pieces(i, j, cut_[0]),
                      &of_source = pairs_.hidden_parts().pieces(j, i, cut_[1]);
    const bool is_cut = &of_receiver != &receiver.pieces || &of_source != &source.pieces;
    if (standing_between_.empty() && !is_cut) return unoccluded = true, 0;

    double total = 0;
    bool all = true;
    for (const std::vector<Point>& piece_r : of_receiver)
        for (const std::vector<Point>& piece_s : of_source) {
            clip(piece_r, source.plane, front_r_);
            clip(piece_s, receiver.plane, front_s_);
            if (front_r_.empty() || front_s_.empty()) continue;
            bool free = false;
            const std::vector<const ConvexBlocker*> between = standing_between_;
            std::erase_if(standing_between_, [&](const ConvexBlocker* b) {
                return sides(*b, front_r_, pairs_.slack()) & sides(*b, front_s_, pairs_.slack());
            });
            double part = 0;
            if (standing_between_.empty())
                free = true;
            else
                part = occluded_pieces(receiver, source, front_r_, front_s_, free);
            standing_between_ = between;
            all &= free;
            if (free) part = exchange_area(front_r_, front_s_, entry_contour_share * tolerance_);
            total += part;
        }
    unoccluded = all && !is_cut;
    return total / receiver.area;
}

double RowWorker::entry(std::size_t i, std::size_t j, double tolerance, Means means) {
    bool cut = false;
    if (i == j || pairs_.is_hidden(i, j) || !pairs_.face_each_other(i, j, cut)) return 0;
    const double usual = std::exchange(tolerance_, tolerance);
    is_alone_ = true;
    max_evaluations_ = means == Means::patient ? patient_evaluations : usual_evaluations;
    pairs_.find_blockers(i, of_row_);
    pairs_.find_blockers(i, j, of_row_, of_pair_);
    is_cluttered_ = of_pair_.size() > many_blockers || means != Means::usual;
    bool unoccluded = of_pair_.empty() && !has_hidden_parts(i, j);
    double F = unoccluded ? 0 : occluded(i, j, of_pair_, unoccluded);
    const ViewFace &receiver = pairs_.faces()[i], &source = pairs_.faces()[j];
    if (unoccluded)
        F = exchange_area(receiver.outline, source.outline, entry_contour_share * tolerance_) / receiver.area;
    tolerance_ = usual, is_alone_ = false, max_evaluations_ = usual_evaluations;
    return std::clamp(F, 0.0, 1.0);
}

void RowWorker::compute(std::size_t i, std::span<double> row) {
    pairs_.find_blockers(i, of_row_);
    for (std::size_t j = 0; j < pairs_.faces().size(); ++j) {
        bool cut = false;
        if (stop_.requested()) return;
        if (j == i || pairs_.is_hidden(i, j) || !pairs_.face_each_other(i, j, cut)) continue;
        pairs_.find_blockers(i, j, of_row_, of_pair_);
        is_cluttered_ = of_pair_.size() > many_blockers;
        bool unoccluded = of_pair_.empty() && !has_hidden_parts(i, j);
        if (!unoccluded) row[j] = occluded(i, j, of_pair_, unoccluded);
        if (!unoccluded) continue;
        row[j] = 0;
        add_unoccluded(i, j, cut);
    }
    flush_batches(i, row);
    for (double& F : row) F = std::clamp(F, 0.0, 1.0);
}

}  // namespace exitance

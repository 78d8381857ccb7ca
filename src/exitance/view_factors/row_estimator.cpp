#include "exitance/view_factors/row_estimator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/limits.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/pair_form_factor.hpp"
#include "exitance/view_factors/closed_variance.hpp"
#include "exitance/view_factors/pooled_row.hpp"

namespace exitance {
namespace {

/// Purposes of a row's random numbers.
enum class Use : std::uint64_t { pilot, cast, pair_pilot, pair };

constexpr std::size_t pilot_batches = 4, pilot_rays_a_batch = 256;

/// Costs in units of a cast ray (0.25 us), measured in an office of 446 polygons and a room with 180 blocks: finding
/// the blockers between two faces, and a pair's pilot; a shadow ray. Measured by `exitance viewfactors SCENE --error
/// 2e-3` for a chair: a quarter and four times of either cost change times by less than 6%.
constexpr double pair_cost = 12, shadow_ray_cost = 0.25;

/// Variances decrease with the number of samples n like n^-rate. Derived from stratified samples in four dimensions for
/// an integrand with a discontinuity.
constexpr double cast_rate = 1.25, pair_rate = 1.25;

constexpr double near_kernel_sizes =  ///< Distance over the larger face's size; kernels of nearer pairs vary too much.
    0.5;
/// Width of an overlap of two faces, as a share of the width of the lower one, that hides a negligible part of it;
/// derived from half of the share of a face below others that NarrowGaps leaves out.
constexpr double negligible_overlap = 1e-4;
/// Share of the error: tolerance of the contour integral. Measured by `exitance viewfactors SCENE --error 2e-3`: a
/// quarter and four times of it give the same errors and times. Derived from integrated_share: the contours are a
/// hundred times as accurate as the sum of their terms.
constexpr double contour_share = 1e-4;
/// Share of the error for integrated entries, with cancellation in sums. Measured by `exitance viewfactors SCENE
/// --error 2e-3`: a quarter and four times of it change errors and times by less than 15%, without a trend.
constexpr double integrated_share = 1e-2;
/// Distances as shares of the scene's size: height up to which another face covers a face, and distance up to which
/// faces count as touching. Derived from coplanar_share: ten times the distance of coplanar faces, and ten times as
/// much again.
constexpr double covering_height = 1e-5, touching_distance = 1e-4;
/// Faces are candidates above this share of the view factor at which a pair is cheaper by itself. Measured by
/// `exitance viewfactors SCENE --error 2e-3`: a quarter and four times of it give the same errors and times.
constexpr double candidate_share = 0.1;
constexpr std::size_t min_batches = 8, min_rays_a_batch = 16;
/// Rays that find the shares of sky and backs: up to max_sky_rays, and at least sky_rays_per_error / R, so that a
/// small share is noticed. Derived from the share exp(-1.5) of rows, a fifth, whose rays all miss a share of R.
constexpr double sky_rays_per_error = 1.5, min_sky_rays = 2048, max_sky_rays = 65536;
constexpr std::size_t max_rays = std::size_t{1} << 30;
constexpr int max_attempts = 6;

/// Number of batches and rays per batch (a power of two), at least n rays in all.
std::pair<std::size_t, std::size_t> batches_of(double n, std::size_t fewest, std::size_t smallest) {
    const double each = std::max(static_cast<double>(smallest), n / static_cast<double>(2 * fewest));
    const std::size_t rays = std::bit_ceil(static_cast<std::size_t>(std::ceil(each)));
    const auto batches = static_cast<std::size_t>(std::ceil(n / static_cast<double>(rays)));
    return {std::max(fewest, batches), rays};
}

/// Returns the number of rays to cast if they estimate a `share` of the row and may cause half of `variance`, the
/// allowed variance of the row.
double cast_rays_for(double share, double variance) {
    return std::pow(share / (0.5 * variance), 1 / cast_rate);
}

/// True if a line parallel to an edge of face a separates two nearly coplanar faces, up to an overlap of `margin`,
/// metres. The boxes of neighbours that are not parallel to the axes overlap. At most 16 edges are tried.
bool are_apart(const ViewFace& a, const ViewFace& b, double margin) {
    constexpr std::size_t max_edges = 16;
    for (std::size_t i = 0; i < std::min(a.outline.size(), max_edges); ++i) {
        const Vec3 edge = a.outline[(i + 1) % a.outline.size()] - a.outline[i];
        const double length = norm(edge);
        if (!(length > 0)) continue;
        const Normal inwards = (1 / length) * cross(a.plane.n, edge);
        double border = HUGE_VAL, farthest = -HUGE_VAL;
        for (const Point& p : a.outline) border = std::min(border, dot(inwards, p));
        for (const Point& p : b.outline) farthest = std::max(farthest, dot(inwards, p));
        if (farthest <= border + margin) return true;
    }
    return false;
}

/// Number of further samples, in units of those taken, after which the pooled estimates have `ratio` times the
/// deviation: (1 + r^(2 - rate)) / (1 + r)^2 = ratio^2.
double further_samples(double ratio) {
    // A margin, since the pilot's predictions have errors of some 20%. Measured by `exitance viewfactors SCENE --error
    // 2e-3`: a quarter of the margin takes 1.6 times as long; without one, rows are repeated and take 1.2 times as
    // long. The others bound the search.
    constexpr double safety = 0.95, least = 0.1, most = 64;
    const double wanted = safety * ratio * ratio;
    // Derived from min_row_error and max_rays: smaller variances per cost do not occur.
    double low = least, high = most;
    for (int step = 0; step < 30; ++step) {
        const double r = std::sqrt(low * high);
        ((1 + std::pow(r, 2 - cast_rate)) / ((1 + r) * (1 + r)) > wanted ? low : high) = r;
    }
    return high;
}

}  // namespace

RowEstimator::RowEstimator(const RowScene& scene, const RowDemand& demand, std::uint64_t seed, const StopRequest& stop)
    : scene_(scene),
      error_(demand.error),
      missed_error_(demand.missed_error),
      deviations_(demand.deviations),
      seed_(seed),
      stop_(stop),
      caster_(scene, stop),
      sampler_(scene),
      seen_by_pilot_(scene.faces.size()) {}

/// Standard deviation of one shadow ray's estimate. The pilot's visible share is moved away from 0 and 1, since few
/// rays give no reliable value there.
double RowEstimator::Pair::deviation() const {
    const double n = PairSampler::pilot_rays, p = (visible * n + 0.5) / (n + 1);
    return unoccluded * std::sqrt(left * p * (1 - p));
}

/// Share of a cast entry's variance that remains after combination with the other row, if both cast equally many rays:
/// together they are equivalent to n + n A_i / A_j rays cast from i.
double RowEstimator::left_of_cast(std::size_t face, std::uint32_t column) const {
    return std::pow(1 + scene_.faces[face].area / scene_.faces[column].area, -cast_rate);
}

/// Like left_of_cast(), for the samples that a pair has for itself: if both rows have equal requirements, their numbers
/// of samples have the ratio (U_ij / U_ji)^(2 / (1 + rate)).
double RowEstimator::left_of_pair(std::size_t face, std::uint32_t column) const {
    const double ratio = scene_.faces[face].area / scene_.faces[column].area;
    return std::pow(1 + std::pow(ratio, 2 / (1 + pair_rate)), -pair_rate);
}

/// Limit on the error of a row after it is combined.
double RowEstimator::combined_limit(const RawRow& row) const {
    ClosedVariance sum;
    auto pair = pairs_.begin();
    for (const RowEntry& entry : row.entries) {
        while (pair != pairs_.end() && pair->column < entry.column) ++pair;
        const bool by_pair = pair != pairs_.end() && pair->column == entry.column && !pair->to_cast;
        sum.add(double(entry.variance) * (by_pair ? pair->left : left_of_cast(row.face, entry.column)));
    }
    return std::sqrt(sum.limit(row.missed_variance, deviations_)) + row.bound;
}

/// True if `other` may cover part of the face, so that rays starting there are blocked at once (Occluders::is_covered).
bool RowEstimator::may_be_under(std::size_t face, std::size_t other) const {
    const ViewFace &a = scene_.faces[face], &b = scene_.faces[other];
    if (std::abs(dot(a.plane.n, b.plane.n)) < parallel_cosine) return false;
    const double reach = covering_height * scene_.scene.size();
    for (std::size_t k = 0; k < 3; ++k)
        if (a.box.lo[k] > b.box.hi[k] + reach || b.box.lo[k] > a.box.hi[k] + reach) return false;
    const double height = a.plane.signed_distance(b.outline[0]);
    if (std::abs(height) > reach || (dot(a.plane.n, b.plane.n) > 0 && height <= scene_.slack)) return false;
    const double margin =
        negligible_overlap * std::min(a.area / std::max(a.diameter, min_divisor), scene_.scene.size());
    return !are_apart(a, b, margin) && !are_apart(b, a, margin);
}

/// Finds the faces that may be visible from the face, with approximate unoccluded view factors, in descending order.
void RowEstimator::find_candidates(std::size_t face) {
    const ViewFace& own = scene_.faces[face];
    const Point x = scene_.middles[face];
    const double reach = scene_.radii[face] + touching_distance * scene_.scene.size();
    // A pair is treated individually if that saves at least this number of cast rays.
    const double negligible = candidate_share * pair_cost * cast_rate / cast_rays_for(1, error_ * error_);
    candidates_.clear();
    under_others_ = scene_.hidden_parts.has(face);
    scene_.near.visit(x, reach, negligible, [&](std::uint32_t j) {
        const ViewFace& other = scene_.faces[j];
        bool cut = false;
        if (j == face) return;
        const Vec3 apart = scene_.middles[j] - x;
        const double apart2 = dot(apart, apart), touching = reach + scene_.radii[j];
        if (apart2 > 4 * touching * touching && other.area < pi * apart2 * negligible) return;
        if (!face_each_other(own, other, scene_.slack, cut)) {
            under_others_ = under_others_ || may_be_under(face, j);
            return;
        }
        const Vec3& d = apart;
        const double squared = std::max(apart2, min_divisor);
        const double cosines =
            cut ? squared : std::max(0.0, dot(own.plane.n, d)) * std::max(0.0, -dot(other.plane.n, d));
        const double about = cosines / (pi * squared * squared) * other.area;
        candidates_.push_back({std::min(about, 1.0), j});
    });
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.about > b.about || (a.about == b.about && a.column < b.column);
    });
}

/// View factor from which candidates are treated individually. Minimizes the estimated cost of treating them and of
/// casting rays for the others, whose number follows from the pilot's hits of the others.
double RowEstimator::smallest_candidate(std::size_t face, double variance) {
    const double n = static_cast<double>(pilot_batches * pilot_rays_a_batch);
    std::vector<double>& seen = seen_by_pilot_;
    double left = 1 / n;
    for (const RowCaster::Count& count : pilot_) {
        seen[count.column] = count.hits / n * left_of_cast(face, count.column);
        left += seen[count.column];
    }
    double best = HUGE_VAL, least = HUGE_VAL;
    const auto consider = [&](std::size_t taken, double smallest) {
        const double rays = cast_rays_for(std::max(left, 1 / n), variance);
        const double cost = static_cast<double>(taken) * pair_cost + rays;
        if (cost < least) least = cost, best = smallest;
    };
    consider(0, HUGE_VAL);
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
        left -= seen[candidates_[k].column];
        consider(k + 1, candidates_[k].about);
    }
    for (const RowCaster::Count& count : pilot_) seen[count.column] = 0;
    return best;
}

/// True if so many hidden parts would be cut off the faces of a pair that casting rays for it costs less. Cutting one
/// part off either face leaves about one more pair of pieces for each piece of the other face.
bool RowEstimator::has_many_pieces(std::size_t face, const Candidate& candidate) const {
    const HiddenParts& hidden = scene_.hidden_parts;
    if (!hidden.has(face) && !hidden.has(candidate.column)) return false;
    const double rays = cast_rays_for(candidate.about, error_ * error_);
    const auto limit = static_cast<std::size_t>(std::ceil(rays / pair_cost)) + 1;
    const std::size_t of_face = 1 + hidden.count_from(face, candidate.column, limit),
                      of_other = 1 + hidden.count_from(candidate.column, face, limit);
    const auto pairs = static_cast<double>(of_face) * static_cast<double>(of_other);
    return pairs > 1 && pair_cost * pairs > rays;
}

/// Visibility between all pieces of two faces.
View RowEstimator::view_of(std::size_t face, std::size_t other, const ConvexParts& own_pieces,
                           const ConvexParts& other_pieces) {
    const ViewFace &a = scene_.faces[face], &b = scene_.faces[other];
    bool any = false, all = true;
    for (const std::vector<Point>& piece_a : own_pieces)
        for (const std::vector<Point>& piece_b : other_pieces) {
            shaft_.set(scene_.occluders, {piece_a, a.plane.n, scene_.region(face), false},
                       {piece_b, b.plane.n, scene_.region(other), false});
            const View view = shaft_.classify(blockers_, 0);
            any |= view != View::none, all &= view == View::open;
            if (any && !all) return View::mixed;
        }
    return !any ? View::none : all ? View::open : View::mixed;
}

/// Exchange area of the parts of two faces that are not hidden, m^2.
double RowEstimator::unoccluded_exchange(std::size_t face, std::size_t other, const ConvexParts& own_pieces,
                                         const ConvexParts& other_pieces) const {
    const ViewFace &a = scene_.faces[face], &b = scene_.faces[other];
    const double tolerance = contour_share * error_;
    if (&own_pieces == &a.pieces && &other_pieces == &b.pieces) return exchange_area(a.outline, b.outline, tolerance);
    double sum = 0;
    for (const std::vector<Point>& piece_a : own_pieces)
        for (const std::vector<Point>& piece_b : other_pieces) sum += exchange_area(piece_a, piece_b, tolerance);
    return sum;
}

void RowEstimator::classify_pair(std::size_t face, Pair& pair, std::uint32_t round) {
    const ViewFace &own = scene_.faces[face], &other = scene_.faces[pair.column];
    const HiddenParts& hidden = scene_.hidden_parts;
    const ConvexParts &own_pieces = hidden.pieces(face, pair.column, cut_[0]),
                      &other_pieces = hidden.pieces(pair.column, face, cut_[1]);
    const View view = view_of(face, pair.column, own_pieces, other_pieces);
    pair.is_exact = view != View::mixed;
    if (view == View::none) return;
    pair.to_cast =
        !pair.is_exact && (under_others_ || hidden.can_be_met(pair.column) ||
                           box_distance(own, other) < near_kernel_sizes * std::max(own.diameter, other.diameter));
    if (pair.to_cast) return;
    pair.unoccluded = (pair.is_exact ? unoccluded_exchange(face, pair.column, own_pieces, other_pieces)
                                     : exchange_area(own.outline, other.outline, contour_share * error_)) /
                      own.area;
    pair.visible = pair.is_exact ? 1
                                 : sampler_.visible_share(face, pair.column,
                                                          hash(seed_, face, round, std::uint64_t(Use::pair_pilot),
                                                               std::uint64_t(pair.column)));
}

void RowEstimator::classify(std::size_t face, std::uint32_t round) {
    const double smallest = smallest_candidate(face, error_ * error_);
    pairs_.clear();
    for (const Candidate& candidate : candidates_) {
        if (candidate.about < smallest || stop_.requested()) break;
        if (has_many_pieces(face, candidate)) continue;
        Pair& pair = pairs_.emplace_back();
        pair.column = candidate.column, pair.left = left_of_pair(face, candidate.column);
        classify_pair(face, pair, round);
    }
    std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) { return a.column < b.column; });
    const double n = static_cast<double>(pilot_batches * pilot_rays_a_batch);
    rest_ = rest_squares_ = rest_cubes_ = 0;
    add_rest(1 / n);
    for (const RowCaster::Count& count : pilot_) {
        const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), count.column,
                                         [](const Pair& pair, std::uint32_t column) { return pair.column < column; });
        if (at == pairs_.end() || at->column != count.column || at->to_cast)
            add_rest(count.hits / n * (1 - count.hits / n) * left_of_cast(face, count.column));
    }
}

/// Numbers of samples that reach a limit on the squared error at the least cost: for variances a^2 n^-r, one more
/// sample must reduce the variance by the same amount per cost in all estimators.
RowEstimator::Plan RowEstimator::plan(double limit) {
    const double for_sky = std::pow(missed_deviation_ / (missed_error_ * missed_error_), 1 / cast_rate);
    const double min_cast = std::max({double(min_batches * min_rays_a_batch), std::min(for_sky, max_sky_rays),
                                      std::min(sky_rays_per_error / error_, min_sky_rays)});
    const auto pair_samples = [&](const Pair& pair, double price) {
        const double a = pair.deviation();
        return std::max<double>(PairSampler::pilot_rays,
                                std::pow(pair_rate * a * a / (price * shadow_ray_cost), 1 / (1 + pair_rate)));
    };
    const auto cast_samples = [&](double price) {
        return std::max<double>(min_cast, std::pow(cast_rate * rest_ / price, 1 / (1 + cast_rate)));
    };
    const auto limit_at = [&](double price) {
        const double each = std::pow(cast_samples(price), -cast_rate);
        ClosedVariance sum;
        sum.add(rest_ * each, rest_squares_ * each * each, rest_cubes_ * each * each * each);
        for (const Pair& pair : pairs_) {
            if (pair.is_exact || pair.to_cast) continue;
            const double a = pair.deviation();
            sum.add(a * a * std::pow(pair_samples(pair, price), -pair_rate));
        }
        return sum.limit(missed_ * each, deviations_);
    };
    // Bounds on the variance that a unit of cost removes. Derived from min_row_error and max_rays: it is not smaller.
    double low = 1e-40, high = 1;
    for (int step = 0; step < 60; ++step) {
        const double price = std::sqrt(low * high);
        (limit_at(price) > limit ? high : low) = price;
    }
    for (Pair& pair : pairs_) std::tie(pair.batches, pair.rays_a_batch) = batches_of(pair_samples(pair, low), 4, 4);
    Plan plan;
    std::tie(plan.batches, plan.rays_a_batch) =
        batches_of(std::min<double>(max_rays, cast_samples(low)), min_batches, min_rays_a_batch);
    return plan;
}

RawRow RowEstimator::measure(std::size_t face, std::uint32_t round, const Plan& plan) {
    const double area = scene_.faces[face].area;
    RawRow row;
    row.face = static_cast<std::uint32_t>(face), row.round = round;
    caster_.cast(face, plan.batches, plan.rays_a_batch, under_others_,
                 hash(seed_, face, round, std::uint64_t(Use::cast), std::uint64_t(0)));
    row.rays = row.cast_rays = caster_.rays();
    row.cast_density = static_cast<double>(row.rays) / area;
    row.sky = caster_.share(caster_.sky()), row.sky_variance = caster_.variance(caster_.sky());
    row.back = caster_.share(caster_.back()), row.back_variance = caster_.variance(caster_.back());
    row.missed_variance = caster_.missed_variance();
    const auto add_cast = [&](const RowCaster::Count& count) {
        row.entries.push_back({caster_.share(count), count.column, static_cast<float>(caster_.variance(count)),
                               static_cast<float>(row.cast_density)});
    };
    const auto add_pair = [&](const Pair& pair) {
        if (pair.is_exact) {
            row.entries.push_back({pair.unoccluded, pair.column, 0, integrated});
            row.bound += integrated_share * error_ * pair.unoccluded;
            return;
        }
        const PairSampler::Estimate found =
            sampler_(face, pair.column, pair.unoccluded, pair.visible, pair.batches, pair.rays_a_batch,
                     hash(seed_, face, round, std::uint64_t(Use::pair), std::uint64_t(pair.column)));
        const double n = static_cast<double>(pair.batches * pair.rays_a_batch);
        row.rays += pair.batches * pair.rays_a_batch;
        // n samples of variance U^2 / 4 are equivalent to 2 n / U cast rays, each with a variance of about U / 2.
        row.entries.push_back({found.F, pair.column, static_cast<float>(found.variance),
                               static_cast<float>(2 * n / (pair.unoccluded * area))});
    };
    const std::span<const RowCaster::Count> counts = caster_.counts();
    std::size_t k = 0;
    for (const Pair& pair : pairs_) {
        for (; k < counts.size() && counts[k].column < pair.column; ++k) add_cast(counts[k]);
        if (pair.to_cast) continue;
        if (k < counts.size() && counts[k].column == pair.column) ++k;
        add_pair(pair);
    }
    for (; k < counts.size(); ++k) add_cast(counts[k]);
    return row;
}

std::optional<RawRow> RowEstimator::operator()(std::size_t face, std::uint32_t round, double share,
                                               const RawRow* before) {
    find_candidates(face);
    caster_.cast(face, pilot_batches, pilot_rays_a_batch, under_others_,
                 hash(seed_, face, round, std::uint64_t(Use::pilot), std::uint64_t(0)));
    pilot_.assign(caster_.counts().begin(), caster_.counts().end());
    const double sky = caster_.share(caster_.sky()), back = caster_.share(caster_.back());
    missed_ = sky + back, missed_deviation_ = std::max(sky * (1 - sky), back * (1 - back));
    classify(face, round);
    const double wanted = share * error_;
    RawRow row;
    double samples = 0;  // number of samples, relative to the plan for `wanted`
    if (before) {
        row = *before;
        samples = std::pow(wanted / std::max(combined_limit(row), wanted), 2 / cast_rate);
    }
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        const double limit = samples > 0 ? combined_limit(row) : HUGE_VAL;
        if (limit <= wanted) break;
        const double more = samples > 0 ? samples * further_samples(wanted / limit) : 1;
        const std::uint64_t key = hash(round, static_cast<std::uint64_t>(attempt));
        const double aim = wanted * wanted * std::pow(more, -cast_rate);
        const RawRow measured = measure(face, static_cast<std::uint32_t>(key), plan(aim));
        if (stop_.requested()) return {};
        row = samples > 0 ? pooled(row, measured) : measured;
        samples += more;
    }
    row.round = round;
    return row;
}

}  // namespace exitance

#include "exitance/view_factors/ray_check.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/view_factors/accuracy.hpp"
#include "exitance/view_factors/row_scene.hpp"

namespace exitance {
namespace {

constexpr std::size_t batches = 64;  ///< the mean of this many is approximately normal
/// An entry that differs from its estimate by more than this number of standard errors is wrong. With 64 batches,
/// chance alone causes such a difference for one correct entry in ten million. The largest difference of 3,200 entries
/// of four scenes, checked with the default number of rays, was 4.1 (`viewfactors --seed 1` to 8).
constexpr double max_deviations = 6;
/// Distance over the larger face's size; the kernel of nearer pairs is unbounded. Measured by `exitance viewfactors
/// SCENE --tolerance 1e-3 --check 200` for boxes: with four times as much, the median error of the rays is 1.7 times
/// as large; with a quarter, 0.8 times.
constexpr double near_sizes = 0.2;

/// Mean of the batches' means, and its standard error.
struct BatchSums {
    double sum = 0, squares = 0;
    void add(double mean) { sum += mean, squares += mean * mean; }
    double mean() const { return sum / batches; }
    double squared_error() const {
        const double variance = (squares - sum * sum / batches) / (batches - 1);
        return std::max(0.0, variance) / batches;
    }
};

/// Estimates F by points on both faces: the mean of the kernel cos cos / (pi r^2) over unoccluded pairs.
RayEntry by_points(const RowScene& ready, std::size_t i, std::size_t j, std::size_t rays, std::uint64_t seed) {
    const FaceSampler &from = ready.samplers[i], &to = ready.samplers[j];
    const bool hides_x = ready.hidden_parts.has(i), hides_y = ready.hidden_parts.has(j);
    const std::size_t each = (rays + batches - 1) / batches;
    std::vector<Point> xs, ys;
    std::vector<double> kernels;
    const std::unique_ptr<bool[]> blocked(new bool[each]);
    BatchSums sums;
    double unoccluded = 0;
    for (std::size_t b = 0; b < batches; ++b) {
        const ScrambledSobol points(hash(seed, b));
        xs.clear(), ys.clear(), kernels.clear();
        for (std::uint32_t k = 0; k < each; ++k) {
            const Point x = from(points(k, 0), points(k, 1)), y = to(points(k, 2), points(k, 3));
            const Vec3 d = y - x;
            const double near = dot(from.normal(), d), far = -dot(to.normal(), d), squared = dot(d, d);
            if (near <= 0 || far <= 0) continue;
            xs.push_back(x), ys.push_back(y);
            kernels.push_back(near * far / (pi * squared * squared) * to.area());
        }
        ready.tracer.occluded(xs, ys, ready.region(i), ready.region(j), std::span(blocked.get(), xs.size()));
        for (std::size_t k = 0; k < xs.size(); ++k)
            blocked[k] = blocked[k] || (hides_x && ready.is_hidden(xs[k], i)) || (hides_y && ready.is_hidden(ys[k], j));
        double sum = 0;
        for (std::size_t k = 0; k < xs.size(); ++k) unoccluded += kernels[k], sum += blocked[k] ? 0 : kernels[k];
        sums.add(sum / static_cast<double>(each));
    }
    // One more ray might have been unoccluded: if few are, their spread is no reliable error.
    const double all = static_cast<double>(each * batches), one = unoccluded / all / all;
    return {sums.mean(), std::sqrt(sums.squared_error() + one * one), each * batches};
}

/// Estimates F by rays of density cos / pi from a face: the share that hits the other's front first.
RayEntry by_directions(const RowScene& ready, std::size_t i, std::size_t j, std::size_t rays, std::uint64_t seed) {
    const FaceSampler& from = ready.samplers[i];
    const bool hides_start = ready.hidden_parts.has(i), hides_hit = ready.hidden_parts.has(j);
    const std::size_t each = (rays + batches - 1) / batches;
    std::vector<Point> xs(each);
    std::vector<Vec3> directions(each);
    std::vector<RayHit> hits(each);
    const Frame frame(from.normal());
    BatchSums sums;
    for (std::size_t b = 0; b < batches; ++b) {
        const ScrambledSobol points(hash(seed, b));
        for (std::uint32_t k = 0; k < each; ++k) {
            xs[k] = from(points(k, 0), points(k, 1));
            directions[k] = cosine_direction(frame, points(k, 2), points(k, 3));
        }
        ready.tracer.nearest(xs, directions, ready.region(i), hits);
        std::size_t met = 0;
        for (std::size_t k = 0; k < each; ++k) {
            if (hits[k].surface.is_none() || hits[k].surface.value != j || !hits[k].front) continue;
            if (hides_start && ready.is_hidden(xs[k], i)) continue;
            met += !hides_hit || !ready.is_hidden(place_of(ready.scene, hits[k], xs[k], directions[k]), j);
        }
        sums.add(static_cast<double>(met) / static_cast<double>(each));
    }
    const double one = 1 / static_cast<double>(each * batches);
    return {sums.mean(), std::sqrt(sums.squared_error() + one * one), each * batches};
}

struct DrawnEntry {
    std::uint32_t i, j;
    double F;
};

/// Draws entries above the smallest one without repetition.
std::vector<DrawnEntry> draw_entries(const SparseFactors& table, const RayCheckOptions& options) {
    std::vector<DrawnEntry> above;
    for (std::uint32_t i = 0; i < table.size(); ++i)
        for (std::size_t k = table.starts[i]; k < table.starts[i + 1]; ++k)
            if (table.values[k] > smallest_entry) above.push_back({i, table.columns[k], table.values[k]});
    const std::size_t count = std::min(options.entries, above.size());
    RandomStream random(options.seed, Stream::reference, table.size());
    for (std::size_t k = 0; k < count; ++k) {  // a random selection: the first steps of a shuffle
        const auto rest = static_cast<double>(above.size() - k);
        std::swap(above[k], above[std::min(above.size() - 1, k + static_cast<std::size_t>(random.uniform() * rest))]);
    }
    above.resize(count);
    return above;
}

}  // namespace

RayEntry view_factor_by_rays(const RowScene& ready, std::size_t i, std::size_t j, std::size_t rays,
                             std::uint64_t seed) {
    const FaceSampler &one = ready.samplers[i], &two = ready.samplers[j];
    const Vec3 apart = max(max(two.box().lo - one.box().hi, one.box().lo - two.box().hi), Vec3{});
    const double size = std::max(one.box().diagonal(), two.box().diagonal());
    if (norm(apart) > near_sizes * size) return by_points(ready, i, j, rays, seed);
    // More rays from the smaller face hit the other one.
    if (one.area() <= two.area()) return by_directions(ready, i, j, rays, seed);
    RayEntry back = by_directions(ready, j, i, rays, seed);
    back.F *= two.area() / one.area(), back.standard_error *= two.area() / one.area();
    return back;
}

RayCheck check_by_rays(const Scene& scene, const SparseFactors& table, const RayCheckOptions& options,
                       const StopRequest& stop) {
    RayCheck check;
    const std::vector<DrawnEntry> drawn = draw_entries(table, options);
    if (drawn.empty()) return check;
    const RowScene ready(scene, stop);
    std::vector<RayEntry> found(drawn.size());
    std::atomic<bool> stopped{false};
    shared_ranges(
        drawn.size(), 1,
        [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k) {
                if (stop.requested()) stopped = true;
                if (stopped) return;
                const auto [i, j, F] = drawn[k];
                found[k] = view_factor_by_rays(ready, i, j, options.rays,
                                               hash(options.seed, std::uint64_t{i} * table.size() + j));
            }
        },
        [&](std::size_t k) -> RayEntry& { return found[k]; }, {"checked entries"});
    std::vector<double> relative_errors;
    check.is_complete = !(largest_of_all(stopped ? 1 : 0) > 0);
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        if (found[k].rays == 0) continue;
        const double F = drawn[k].F, off = std::abs(F - found[k].F);
        const double relative_error = found[k].standard_error / F;
        ++check.entries, check.rays += found[k].rays;
        relative_errors.push_back(relative_error);
        check.largest_deviation = std::max(check.largest_deviation, off / found[k].standard_error);
        check.wrong += off > options.tolerance * F + max_deviations * found[k].standard_error;
        if (off / F <= check.largest_relative) continue;
        check.largest_relative = off / F, check.relative_error_there = relative_error;
    }
    if (relative_errors.empty()) return check;
    std::nth_element(relative_errors.begin(), relative_errors.begin() + std::ptrdiff_t(relative_errors.size() / 2),
                     relative_errors.end());
    check.usual_relative_error = relative_errors[relative_errors.size() / 2];
    return check;
}

}  // namespace exitance

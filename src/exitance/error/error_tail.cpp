#include "exitance/error/error_tail.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "exitance/calibration/numbers.hpp"

namespace exitance {

double rms_over_bands(const Spectrum& error) {
    return std::sqrt(squared(error) / static_cast<double>(bands));
}

double error_below(std::span<const WeightedError> known, WeightedError rest, double share, double most) {
    std::vector<WeightedError> falling(known.begin(), known.end());
    std::stable_sort(falling.begin(), falling.end(),
                     [](const WeightedError& a, const WeightedError& b) { return a.error > b.error; });
    const auto above = [&](double t) {
        if (!(rest.error > 0) || t >= most) return 0.0;
        return rest.weight * std::erfc(t / (std::numbers::sqrt2 * rest.error));
    };
    // The share of the area above an error t grows as t decreases: in steps at known errors, continuously between them.
    double counted = 0, lower = 0;
    double upper = falling.empty() ? 0 : falling.front().error;
    upper = std::max(upper, 12 * rest.error);  // at 12 standard deviations erfc is negligible
    for (const WeightedError& e : falling) {
        if (counted + above(e.error) > share) {
            lower = e.error;
            break;
        }
        upper = e.error, counted += e.weight;
        if (counted + above(e.error) > share) return e.error;
    }
    for (int step = 0; step < 60; ++step) {
        const double t = 0.5 * (lower + upper);
        (counted + above(t) > share ? lower : upper) = t;
    }
    return upper;
}

double error_below(std::span<const WeightedError> noisy, std::span<const unsigned> rays, double mean_square,
                   double share, const ByMoreRays& measure) {
    std::vector<std::size_t> falling(noisy.size());
    std::iota(falling.begin(), falling.end(), std::size_t(0));
    std::stable_sort(falling.begin(), falling.end(),
                     [&](std::size_t i, std::size_t k) { return noisy[i].error > noisy[k].error; });
    double all = 0, again = 0, all_rays = 0, rays_again = 0;
    for (const WeightedError& e : noisy) all += e.weight;
    for (unsigned n : rays) all_rays += n;
    std::size_t count = 0;
    for (; count < falling.size() && again < calibrated::points_again * all; ++count)
        again += noisy[falling[count]].weight, rays_again += rays[falling[count]];
    if (again <= 0) return 0;
    const std::span<const std::size_t> which = std::span(falling).first(count);
    // Casts a quarter of the rays of all places again, but at most 64 times those of the repeated places.
    constexpr int part = 4, max_factor = 64;
    const double times = std::clamp(all_rays / (part * rays_again), 2.0, static_cast<double>(max_factor));
    const auto factor = std::bit_floor(static_cast<unsigned>(times));
    std::vector<TwoErrors> error(count);
    measure(which, factor, error);
    double noise = 0, known_square = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& [e1, e2] = error[i];
        noise += noisy[which[i]].weight / again * squared(0.5 * (e1 - e2)) / static_cast<double>(bands);
        known_square += noisy[which[i]].weight * mean(e1 * e2);
    }
    std::vector<WeightedError> known(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double size = rms_over_bands(0.5 * (error[i][0] + error[i][1]));
        known[i] = {std::sqrt(std::max(0.0, size * size - noise)), noisy[which[i]].weight};
    }
    const double left = std::max(0.0, all - again);
    const double rest = left > 0 ? std::sqrt(std::max(0.0, mean_square - known_square) / left) : 0;
    return error_below(known, {rest, left}, share * all, noisy[which.back()].error);
}

}  // namespace exitance

#include "exitance/view_factors/pair_sampler.hpp"

#include <algorithm>

#include "exitance/base/random.hpp"

namespace exitance {

PairSampler::Sums PairSampler::sample(std::size_t i, std::size_t j, std::size_t rays, std::uint64_t seed) {
    const FaceSampler &from = scene_.samplers[i], &to = scene_.samplers[j];
    const ScrambledSobol points(seed);
    Sums sums;
    for (std::size_t first = 0; first < rays; first += block) {
        const std::size_t count = std::min(block, rays - first);
        for (int d = 0; d < 4; ++d)
            points.fill(static_cast<std::uint32_t>(first), d, std::span(coordinates_[d]).first(count));
        std::size_t facing = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const Point x = from(coordinates_[0][k], coordinates_[1][k]),
                        y = to(coordinates_[2][k], coordinates_[3][k]);
            const Vec3 d = y - x;
            const double near = dot(from.normal(), d), far = -dot(to.normal(), d), squared = dot(d, d);
            if (near <= 0 || far <= 0) continue;
            xs_[facing] = x, ys_[facing] = y;
            kernels_[facing++] = near * far / (pi * squared * squared) * to.area();
        }
        if (facing == 0) continue;
        scene_.tracer.occluded(std::span(xs_).first(facing), std::span(ys_).first(facing), scene_.region(i),
                               scene_.region(j), std::span(blocked_).first(facing));
        for (std::size_t k = 0; k < facing; ++k) {
            sums.kernel += kernels_[k];
            if (!blocked_[k]) sums.visible += kernels_[k], ++sums.seen;
        }
    }
    return sums;
}

double PairSampler::visible_share(std::size_t i, std::size_t j, std::uint64_t seed) {
    return static_cast<double>(sample(i, j, pilot_rays, seed).seen) / static_cast<double>(pilot_rays);
}

PairSampler::Estimate PairSampler::operator()(std::size_t i, std::size_t j, double unoccluded, double expected,
                                              std::size_t batches, std::size_t rays_a_batch, std::uint64_t seed) {
    double sum = 0, squares = 0;
    for (std::size_t b = 0; b < batches; ++b) {
        const Sums of_batch = sample(i, j, rays_a_batch, hash(seed, b));
        const double mean = (of_batch.visible - expected * of_batch.kernel) / static_cast<double>(rays_a_batch);
        sum += mean, squares += mean * mean;
    }
    const double k = static_cast<double>(batches);
    const double spread = std::max(0.0, squares - sum * sum / k) / (k * (k - 1));
    // If all samples agree their spread is 0, but up to about one sample in n may still differ.
    const double one = 0.5 * unoccluded / (k * static_cast<double>(rays_a_batch));
    return {expected * unoccluded + sum / k, spread + one * one};
}

}  // namespace exitance
